// The page as a whole: names and contrast, the keyboard, times, sizes, and pictures for inspection.
import assert from "node:assert/strict";
import { mkdirSync, readFileSync, statSync } from "node:fs";
import { createRequire } from "node:module";
import path from "node:path";
import { test } from "node:test";
import { gzipSync } from "node:zlib";

import { asked, base, close, drop, fresh, out, page, problems } from "./browser.mjs";
import { files, run, scratch } from "./common.mjs";

const shots = process.env.LOBE_WEB_SHOTS ?? path.join(path.dirname(out), "web-shots");

test("two materials are shown", async () => {
    mkdirSync(shots, { recursive: true });
    await drop(page, files().filter(({ name }) => /^(cloth|paint-)/.test(name)));
    await page.locator("h1").click();
    await page.keyboard.press("c");
    await page.waitForFunction(() => /ΔE, mean/.test(document.querySelector("#compared")?.textContent ?? ""), undefined, { timeout: 60_000 });
});

test("every control has a name", async () => {
    const nameless = await page.evaluate(() =>
        [...document.querySelectorAll("button, select, input, canvas[tabindex], dialog")]
            .filter((element) => !element.hidden && !element.getAttribute("aria-label") && !element.getAttribute("aria-labelledby") && !element.textContent.trim() && !element.labels?.length)
            .map((element) => element.outerHTML.slice(0, 120)),
    );
    assert.deepEqual(nameless, []);
});

test("everything is reached by the keyboard, and stays where it is", async () => {
    for (const dismiss of await page.locator(".message button").all()) await dismiss.click().catch(() => {});
    await page.waitForFunction(() => !/Checking/.test(document.querySelector("#findings").textContent));
    const count = await page.evaluate(() => {
        const stops = [...document.querySelectorAll("button, select, input, canvas[tabindex], summary, [tabindex='0']")].filter((element) => element.checkVisibility() && !element.disabled);
        stops.forEach((element, at) => (element.dataset.stop = at));
        document.activeElement?.blur();
        return stops.length;
    });
    assert.ok(count > 25, `${count}`);
    const reached = new Set();
    for (let press = 0; press < count + 10; press++) {
        await page.keyboard.press("Tab");
        const { stop, outline } = await page.evaluate(() => ({ stop: document.activeElement?.dataset.stop, outline: document.activeElement && getComputedStyle(document.activeElement).outlineStyle }));
        if (stop === undefined) continue;
        reached.add(stop);
        assert.notEqual(outline, "none", stop);
    }
    assert.equal(reached.size, count);
    // What is pressed keeps the focus although the list that it is in is made anew.
    for (const of of [".knots button", ".materials button.name"]) {
        await page.locator(of).last().focus();
        await page.keyboard.press("Enter");
        await page.waitForTimeout(50);
        assert.ok(await page.evaluate((of) => document.activeElement?.matches(of), of), of);
    }
    await page.locator("canvas.scene").first().focus();
    const lamp = () => page.evaluate(() => window.explorer.state.view.lamp.join());
    const before = await lamp();
    await page.keyboard.press("ArrowRight");
    assert.notEqual(await lamp(), before);
    await page.locator("#show-help").focus();
    await page.keyboard.press("Enter");
    assert.ok(await page.locator("#help").isVisible());
    await page.keyboard.press("Escape");
    assert.ok(!(await page.locator("#help").isVisible()));
});

test("the rules of axe for accessibility are kept", async () => {
    const source = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
    await page.evaluate(source);
    // Colours that change gently are measured where they are going.
    await page.emulateMedia({ reducedMotion: "reduce" });
    for (const theme of ["light", "dark"]) {
        await page.evaluate((theme) => (document.documentElement.dataset.theme = theme), theme);
        for (const dialog of ["", "show-help", "show-export"]) {
            if (dialog) await page.locator(`#${dialog}`).click();
            const broken = await page.evaluate(async () => {
                const { violations } = await window.axe.run(document, { resultTypes: ["violations"] });
                return violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html.slice(0, 100)).join(" ")}`);
            });
            assert.deepEqual(broken, [], `${theme} ${dialog}`);
            if (dialog) await page.keyboard.press("Escape");
        }
    }
    await page.evaluate(() => delete document.documentElement.dataset.theme);
});

test("text has contrast in both themes", async () => {
    for (const theme of ["light", "dark"]) {
        await page.evaluate((theme) => (document.documentElement.dataset.theme = theme), theme);
        // Buttons change their colour in a transition.
        await page.waitForTimeout(500);
        const poor = await page.evaluate(() => {
            const luminance = (text) => {
                const [r, g, b] = text.match(/[\d.]+/g).map((n) => Number(n) / 255).map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4));
                return 0.2126 * r + 0.7152 * g + 0.0722 * b;
            };
            const behind = (element) => {
                for (let at = element; at; at = at.parentElement) {
                    const colour = getComputedStyle(at).backgroundColor;
                    if (colour.startsWith("rgb(")) return colour;
                }
                return "rgb(255, 255, 255)";
            };
            return [...document.querySelectorAll("h1, h2, h3, p, dt, dd, button, select, output, small, th, td, summary, .badge")]
                .filter((element) => element.offsetParent !== null && element.textContent.trim() && !element.disabled && !element.closest(":disabled"))
                .filter((element) => getComputedStyle(element).color.startsWith("rgb("))
                .map((element) => {
                    const [a, b] = [getComputedStyle(element).color, behind(element)].map(luminance).sort((x, y) => y - x);
                    return { ratio: (a + 0.05) / (b + 0.05), text: `${element.tagName} ${element.className} ${element.textContent.slice(0, 30)}` };
                })
                .filter(({ ratio }) => ratio < 4.5);
        });
        assert.deepEqual(poor, [], theme);
    }
    await page.evaluate(() => delete document.documentElement.dataset.theme);
});

test("first curves come soon after a drop", async () => {
    // A text of about 20 MB, the slowest to read of what is as large.
    const steps = (count, end) => Array.from({ length: count }, (_, at) => ((end * at) / (count - 1)).toFixed(3)).join(",");
    const large = path.join(scratch, "large.ddr");
    run("generate", "ggx", large, "--alpha", "0.3,0.5", "--sigma", steps(18, 85), "--psi", steps(6, 300), "--theta", steps(86, 180), "--phi", steps(72, 355));
    const list = [files().find(({ name }) => name.startsWith("cloth")), { name: "large.ddr", file: large }];
    for (const { name, file } of list) {
        const data = readFileSync(file).toString("base64");
        let least = Infinity;
        for (let turn = 0; turn < 3; turn++) {
            const other = await fresh();
            const took = await other.evaluate(
                async ({ name, data }) => {
                    const transfer = new DataTransfer();
                    transfer.items.add(new File([Uint8Array.from(atob(data), (c) => c.charCodeAt(0))], name));
                    const begun = performance.now();
                    window.dispatchEvent(new DragEvent("drop", { dataTransfer: transfer }));
                    while (!/peak/.test(document.querySelector("#curve-value").textContent)) await new Promise((done) => setTimeout(done, 5));
                    return performance.now() - begun;
                },
                { name, data },
            );
            least = Math.min(least, took);
            await other.close();
        }
        console.log(`${name}, ${(statSync(file).size / 1e6).toFixed(1)} MB: first curves after ${least.toFixed(0)} ms`);
        assert.ok(least < 20_000, name);
    }
});

test("what is downloaded is small", () => {
    let sum = 0;
    const sizes = [];
    for (const url of new Set(asked.filter((url) => url.startsWith(base)).map((url) => url.split(/[?#]/)[0]))) {
        const name = url.slice(base.length) || "index.html";
        const size = gzipSync(readFileSync(path.join(out, name)), { level: 9 }).length;
        sizes.push(`${name} ${size}`);
        sum += size;
    }
    console.log(`${sum} bytes with gzip: ${sizes.join(", ")}`);
    assert.ok(sum < 4e6, String(sum));
});

test("pictures of the page, for inspection", async () => {
    await close(page);
    const by = (start) => files().find(({ name }) => name.startsWith(start));
    for (const [width, height, theme] of [[1280, 1000, "light"], [390, 844, "dark"], [1280, 1000, "dark"], [390, 844, "light"]]) {
        await page.setViewportSize({ width, height });
        await page.emulateMedia({ colorScheme: theme });
        await close(page);
        for (const dismiss of await page.locator(".message button").all()) await dismiss.click().catch(() => {});
        await page.screenshot({ path: path.join(shots, `welcome-${width}-${theme}.png`) });
        await drop(page, [by("paint-"), by("cloth")]);
        await page.locator("h1").click();
        await page.keyboard.press("c");
        await page.evaluate(() => window.explorer.state.set({ sigma: 0.6, chart: "curve", scale: "log", map: "values" }));
        await page.waitForFunction(() => /[4-9] of 256|\d\d+ of 256|done/.test(document.querySelector("#picture-samples").textContent), undefined, { timeout: 120_000 });
        await page.waitForTimeout(500);
        assert.equal(await page.locator(".message.error").count(), 0);
        await page.screenshot({ path: path.join(shots, `page-${width}-${theme}.png`), fullPage: true });
        // Nothing is wider than the window.
        assert.ok((await page.evaluate(() => document.documentElement.scrollWidth)) <= width, `${width}`);
    }
});

test("no other server was asked, and nothing failed unseen", () => {
    assert.deepEqual(asked.filter((url) => !url.startsWith(base) && !url.startsWith("blob:") && !url.startsWith("data:")), []);
    assert.deepEqual(problems, []);
});
