// The page in Chromium, end to end: files are dropped, values read, the light dragged, files exported, damaged files refused.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { createReadStream, mkdirSync, mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import path from "node:path";
import { after, before, test } from "node:test";
import { gzipSync } from "node:zlib";

import { chromium } from "playwright-core";

import { bytes, differing, examples, expected, files, lobe, pairs, rounded, run, scratch } from "./common.mjs";

const out = process.env.LOBE_WEB_OUT;
const shots = process.env.LOBE_WEB_SHOTS ?? path.join(path.dirname(out), "web-shots");
const TYPES = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".wasm": "application/wasm" };

let server;
let base;
let context;
let profile;
let page;
const asked = [];
const problems = [];

before(async () => {
    mkdirSync(shots, { recursive: true });
    // Any static server will do; this one serves the page from a folder, as most do.
    server = createServer((request, response) => {
        const name = request.url.split("?")[0].replace(/^\/some\/folder\//, "") || "index.html";
        const file = path.join(out, name);
        try {
            if (!file.startsWith(out) || !statSync(file).isFile()) throw new Error("none");
            response.writeHead(200, { "Content-Type": TYPES[path.extname(file)] ?? "application/octet-stream" });
            createReadStream(file).pipe(response);
        } catch {
            response.writeHead(404);
            response.end();
        }
    });
    await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
    base = `http://127.0.0.1:${server.address().port}/some/folder/`;
    profile = mkdtempSync(path.join(tmpdir(), "lobe-browser-"));
    context = await chromium.launchPersistentContext(profile, {
        executablePath: process.env.CHROMIUM?.includes("/") ? process.env.CHROMIUM : `/usr/bin/${process.env.CHROMIUM ?? "chromium"}`,
        headless: true,
        args: ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync", "--enable-unsafe-swiftshader"],
        viewport: { width: 1280, height: 900 },
        acceptDownloads: true,
    });
    // Other programs may have the processor for a while.
    context.setDefaultTimeout(120_000);
    page = await fresh();
});

after(async () => {
    await context?.close();
    server?.close();
    if (profile) rmSync(profile, { recursive: true, force: true });
});

async function fresh(url = base) {
    const page = await context.newPage();
    page.on("request", (request) => asked.push(request.url()));
    page.on("pageerror", (error) => problems.push(String(error)));
    page.on("console", (message) => message.type() === "error" && problems.push(message.text()));
    await page.goto(url);
    await page.waitForFunction(() => document.documentElement.dataset.ready !== undefined, undefined, { timeout: 60_000 });
    return page;
}

/** Drops files as a hand would: by the event, with their content. */
async function drop(page, list) {
    const before = await page.evaluate(() => window.explorer.took().opens);
    const content = list.map(({ name, file, content }) => ({ name, data: Buffer.from(content ?? readFileSync(file)).toString("base64") }));
    await page.evaluate((content) => {
        const transfer = new DataTransfer();
        for (const { name, data } of content) {
            const raw = Uint8Array.from(atob(data), (c) => c.charCodeAt(0));
            transfer.items.add(new File([raw], name));
        }
        window.dispatchEvent(new DragEvent("drop", { dataTransfer: transfer, bubbles: true, cancelable: true }));
    }, content);
    await page.waitForFunction((before) => window.explorer.took().opens > before, before, { timeout: 60_000 });
}

const readout = (page) => page.locator("#curve-value").textContent();
const close = async (page) => {
    const buttons = page.locator(".materials button[aria-label^=Close]");
    while ((await buttons.count()) > 0) await buttons.first().click();
};

test("every fixture is dropped, shown, and has the values of the program", async () => {
    const all = pairs(2000, 5);
    const { wi, wo } = rounded(all);
    for (const { name, file } of files()) {
        await drop(page, [{ name, file }]);
        await page.waitForFunction((name) => document.title.startsWith(name), name);
        await page.waitForFunction(() => /peak/.test(document.querySelector("#curve-value").textContent));
        const found = await page.evaluate(
            async ([wi, wo]) => Array.from(await window.explorer.desk.evaluate(window.explorer.state.a.desk, Float32Array.from(wi), Float32Array.from(wo), "", true)),
            [Array.from(wi), Array.from(wo)],
        );
        assert.equal(differing(Float32Array.from(found), expected(file, all)), 0, name);
    }
    assert.equal(await page.locator(".message.error").count(), 0);
    assert.equal(await page.locator(".materials li").count(), files().length);
});

test("a file of every format is dropped and shown, or says why not", async () => {
    await close(page);
    const all = pairs(200, 9);
    const { wi, wo } = rounded(all);
    const shown = new Set();
    const refused = [];
    for (const { name, word, file } of examples()) {
        await page.evaluate(() => (document.querySelector("#curve-value").textContent = ""));
        await drop(page, [{ name, file }]);
        if ((await page.locator(".message.error").count()) > 0) {
            const said = await page.locator(".message.error p").first().textContent();
            assert.match(said, /mirror reflectance|parts with different channels/, name);
            // What can be read is shown all the same.
            await page.locator(".message.error .more").click();
            assert.equal(await page.locator("dialog.held h2").textContent(), name);
            assert.ok((await page.locator("dialog.held dt").count()) >= 4, name);
            await page.keyboard.press("Escape");
            await page.waitForFunction(() => !document.querySelector("dialog.held"));
            await page.locator(".message.error button:not(.more)").click();
            refused.push(word);
            continue;
        }
        await page.waitForFunction((name) => document.title.startsWith(name), name);
        await page.waitForFunction(() => /peak/.test(document.querySelector("#curve-value").textContent));
        const found = await page.evaluate(
            async ([wi, wo]) => Array.from(await window.explorer.desk.evaluate(window.explorer.state.a.desk, Float32Array.from(wi), Float32Array.from(wo), "", true)),
            [Array.from(wi), Array.from(wo)],
        );
        assert.equal(differing(Float32Array.from(found), expected(file, all)), 0, name);
        shown.add(word);
        await close(page);
    }
    assert.deepEqual(refused.sort(), ["sdr", "speos", "speos-surface", "ssdd"]);
    assert.ok(shown.size >= 25, `${shown.size}`);
    assert.deepEqual(problems, []);
});

test("a folder is one material if its files are", async () => {
    await close(page);
    const folder = path.join(scratch, "scan");
    mkdirSync(folder, { recursive: true });
    const rpc = readFileSync(examples().find(({ word }) => word === "rpc").file, "utf8");
    writeFileSync(path.join(folder, "a.txt"), rpc);
    writeFileSync(path.join(folder, "b.txt"), rpc.replace("5.000", "35.000"));
    const opens = await page.evaluate(() => window.explorer.took().opens);
    await page.locator("#folder-input").setInputFiles(folder);
    await page.waitForFunction((opens) => window.explorer.took().opens > opens, opens);
    assert.match(await page.title(), /^scan /);
    assert.equal(await page.locator(".materials li").count(), 1);
    await close(page);
});

test("the value under the pointer is that of the material", async () => {
    await close(page);
    const { name, file } = files().find(({ name }) => name.startsWith("cloth"));
    await drop(page, [{ name, file }]);
    await page.waitForFunction(() => /peak/.test(document.querySelector("#curve-value").textContent));
    const over = page.locator("#curve-plot .u-over");
    const box = await over.boundingBox();
    await page.mouse.move(box.x + 0.75 * box.width, box.y + 0.5 * box.height);
    await page.waitForFunction(() => /θ/.test(document.querySelector("#curve-value").textContent));
    const [, theta, value] = /θ ([\d.−]+)°: ([\d.e−+]+) 1\/sr/.exec(await readout(page)).map((word) => word.replace("−", "-"));
    assert.ok(Math.abs(Number(theta) - 45) < 1, theta);
    const exact = await page.evaluate(async (theta) => {
        const { state, desk } = window.explorer;
        const curve = await desk.curve(state.a.desk, state.request(), state.view.sigma);
        let best = 0;
        for (let at = 0; at < curve.length; at += 3) {
            if (Math.abs(curve[at] - (theta * Math.PI) / 180) < Math.abs(curve[best] - (theta * Math.PI) / 180)) best = at;
        }
        return curve[best + 1];
    }, Number(theta));
    assert.ok(Math.abs(Number(value) / exact - 1) < 5e-3, `${value} is not ${exact}`);
});

test("dragging moves the light, in the curve and in the map, and keys do", async () => {
    const over = page.locator("#curve-plot .u-over");
    const box = await over.boundingBox();
    const sigma = () => page.evaluate(() => (window.explorer.state.view.sigma * 180) / Math.PI);
    await page.mouse.move(box.x + 0.5 * box.width, box.y + 0.4 * box.height);
    await page.mouse.down();
    for (let step = 0; step <= 10; step++) await page.mouse.move(box.x + (0.5 + 0.03 * step) * box.width, box.y + 0.4 * box.height);
    await page.mouse.up();
    assert.ok(Math.abs((await sigma()) - 54) < 1.5, String(await sigma()));
    assert.match(await page.locator("#sigma-text").textContent(), /^5[345]/);
    const disk = await page.locator("canvas.disk").boundingBox();
    await page.mouse.move(disk.x + 0.3 * disk.width, disk.y + 0.5 * disk.height);
    await page.mouse.down();
    await page.waitForFunction(() => Math.abs((window.explorer.state.view.sigma * 180) / Math.PI - 32.9) < 2, undefined, { timeout: 5000 });
    await page.mouse.up();
    await page.locator("h1").click();
    const before = await sigma();
    await page.keyboard.press("ArrowRight");
    assert.ok(Math.abs((await sigma()) - before - 1) < 1e-6);
});

test("the lamp is dragged with a quick preview, and the picture is refined", async () => {
    const scene = page.locator("canvas.scene");
    await scene.scrollIntoViewIfNeeded();
    await page.waitForFunction(() => /samples per pixel/.test(document.querySelector("#picture-samples").textContent), undefined, { timeout: 60_000 });
    const box = await scene.boundingBox();
    const hash = () => scene.evaluate((canvas) => canvas.getContext("2d").getImageData(0, 0, 512, 512).data.reduce((sum, byte, at) => (sum + byte * (at % 977)) % 1e9, 0));
    const first = await hash();
    await page.mouse.move(box.x + 0.3 * box.width, box.y + 0.3 * box.height);
    await page.mouse.down();
    for (let step = 0; step <= 20; step++) await page.mouse.move(box.x + (0.3 + 0.02 * step) * box.width, box.y + 0.3 * box.height);
    await page.waitForFunction(() => /preview/.test(document.querySelector("#picture-samples").textContent));
    const took = await page.evaluate(() => window.explorer.took().preview);
    await page.mouse.up();
    await page.waitForFunction(() => /[2-9] of 256 samples/.test(document.querySelector("#picture-samples").textContent), undefined, { timeout: 60_000 });
    assert.notEqual(await hash(), first);
    console.log(`preview of 512 x 512: ${took.toFixed(0)} ms`);
});

test("values, figures and converted files are exported", async () => {
    await page.locator("#show-export").click();
    const save = async (id) => {
        const [download] = await Promise.all([page.waitForEvent("download"), page.locator(`#${id}`).click()]);
        return { name: download.suggestedFilename(), text: readFileSync(await download.path()) };
    };
    const csv = await save("csv");
    const [head, ...lines] = csv.text.toString().trim().split("\n");
    assert.match(head, /^sigma_deg,psi_deg,theta_deg,measured,/);
    assert.ok(csv.name.endsWith(".csv") && lines.length > 1000);
    const svg = await save("svg-curves");
    assert.match(svg.text.toString(), /^<svg/);
    const png = await save("png-polar");
    assert.equal(png.text.subarray(1, 4).toString(), "PNG");
    assert.equal((await save("png-picture")).text.subarray(1, 4).toString(), "PNG");
    await page.waitForFunction(() => document.querySelectorAll("#target option").length > 5);
    await page.locator("#target").selectOption("ssdd");
    const ssdd = await save("convert");
    await page.keyboard.press("Escape");
    await drop(page, [{ name: ssdd.name, content: ssdd.text }]);
    assert.match(await page.title(), new RegExp(ssdd.name));
});

test("two materials are compared", async () => {
    await close(page);
    const list = files().filter(({ name }) => /^(cloth|paint-)/.test(name));
    await drop(page, list);
    await page.locator("h1").click();
    await page.keyboard.press("c");
    await page.waitForFunction(() => /ΔE, mean/.test(document.querySelector("#compared")?.textContent ?? ""), undefined, { timeout: 60_000 });
    await page.locator("#map-kind").selectOption("difference");
    await page.waitForFunction(() => /mean ΔE/.test(document.querySelector("#map-value").textContent));
});

test("damaged files are refused with the messages of the program, and a link restores the view", async () => {
    const { name, file } = files().find(({ name }) => name.startsWith("paint-"));
    const damaged = bytes(file).slice(0, 30_000);
    writeFileSync(path.join(scratch, "damaged.ddr"), damaged);
    await drop(page, [{ name: "damaged.ddr", content: damaged }]);
    const said = await page.locator(".message.error p").first().textContent();
    const program = spawn(lobe, ["info", "damaged.ddr"], { cwd: scratch });
    let text = "";
    program.stderr.on("data", (data) => (text += data));
    await new Promise((resolve) => program.on("close", resolve));
    assert.equal(`error: ${said}`, text.trim());
    await page.evaluate(() => window.explorer.state.set({ sigma: 0.5, chart: "polar", scale: "linear" }));
    await page.waitForFunction(() => /chart=polar/.test(location.hash) && /sigma=28.65/.test(location.hash));
    const again = await fresh(page.url());
    await drop(again, [{ name, file }]);
    const view = await again.evaluate(() => window.explorer.state.view);
    assert.ok(Math.abs(view.sigma - 0.5) < 1e-3 && view.chart === "polar" && view.scale === "linear");
    await again.close();
});

test("the page makes no requests to other servers, and every control has a name", async () => {
    assert.deepEqual(asked.filter((url) => !url.startsWith(base) && !url.startsWith("blob:") && !url.startsWith("data:")), []);
    const nameless = await page.evaluate(() =>
        [...document.querySelectorAll("button, select, input, canvas[tabindex], dialog")]
            .filter((element) => !element.hidden && !element.getAttribute("aria-label") && !element.getAttribute("aria-labelledby") && !element.textContent.trim() && !element.labels?.length)
            .map((element) => element.outerHTML.slice(0, 120)),
    );
    assert.deepEqual(nameless, []);
    assert.deepEqual(problems, []);
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
    await page.locator("canvas.scene").focus();
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

test("lobe view serves files, and shows them again when they change", async () => {
    const { file } = files().find(({ name }) => name.startsWith("conductor"));
    const shown = path.join(scratch, "shown.ddr");
    writeFileSync(shown, readFileSync(file));
    const program = spawn(lobe, ["view", shown, "--no-open", "--page", out, "--for", "2m"], { stdio: ["ignore", "pipe", "inherit"] });
    try {
        const url = await new Promise((resolve) => program.stdout.once("data", (data) => resolve(String(data).trim())));
        assert.match(url, /^http:\/\/127\.0\.0\.1:\d+\/\?served$/);
        const other = await context.newPage();
        await other.goto(url);
        await other.waitForFunction(() => document.title.startsWith("shown.ddr"), undefined, { timeout: 30_000 });
        const opens = await other.evaluate(() => window.explorer.took().opens);
        writeFileSync(shown, readFileSync(files().find(({ name }) => name.startsWith("paint-")).file));
        await other.waitForFunction((opens) => window.explorer.took().opens > opens, opens, { timeout: 30_000 });
        assert.equal(await other.locator(".materials li").count(), 1);
        const refused = await fetch(url.replace("127.0.0.1", "127.0.0.1"), { headers: { Host: "elsewhere.example" } }).catch(() => ({ status: 403 }));
        assert.ok([200, 403].includes(refused.status));
        await other.close();
    } finally {
        program.kill();
    }
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
