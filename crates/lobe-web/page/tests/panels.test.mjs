// The panels of the page: values are read, the light and the lamp dragged, figures exported.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";

import { asked, base, close, drop, page, problems, readout } from "./browser.mjs";
import { examples, files } from "./common.mjs";

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
    const disk = await page.locator("canvas.disk").first().boundingBox();
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
    const scene = page.locator("canvas.scene").first();
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

test("the preview follows a drag", async () => {
    const took = () => page.evaluate(() => window.explorer.took());
    const rate = async (box, count) => {
        await page.mouse.move(box.x + 0.3 * box.width, box.y + 0.4 * box.height);
        await page.mouse.down();
        const [before, begun] = [await took(), performance.now()];
        for (let step = 0; performance.now() - begun < 3000; step++) {
            const angle = 0.05 * step;
            await page.mouse.move(box.x + (0.5 + 0.3 * Math.cos(angle)) * box.width, box.y + (0.5 + 0.2 * Math.sin(angle)) * box.height);
        }
        const [after, seconds] = [await took(), (performance.now() - begun) / 1000];
        await page.mouse.up();
        return (after[count] - before[count]) / seconds;
    };
    const lamp = await rate(await page.locator("canvas.scene").first().boundingBox(), "previews");
    await page.locator("#curve-plot .u-over").scrollIntoViewIfNeeded();
    const light = await rate(await page.locator("#curve-plot .u-over").boundingBox(), "curves");
    console.log(`a second: ${lamp.toFixed(0)} pictures of 512 x 512 while the lamp is dragged, ${light.toFixed(0)} curves while the light is`);
    assert.ok(lamp > 2 && light > 2);
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
    // Both are shown side by side: on disks of one scale, and under the lamp.
    await page.waitForFunction(() => [...document.querySelectorAll("canvas.scene, canvas.disk")].every((canvas) => canvas.checkVisibility()));
    await page.waitForFunction(() => /[1-9]\d* of 256 samples/.test(document.querySelector("#picture-samples").textContent), undefined, { timeout: 60_000 });
    const dark = await page.evaluate(() =>
        [...document.querySelectorAll("canvas.scene")].filter((canvas) => !canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data.some((byte, at) => at % 4 < 3 && byte > 100)).length,
    );
    assert.equal(dark, 0);
    assert.deepEqual(await page.locator("#curves .keys > span").allTextContents(), await page.evaluate(() => [window.explorer.state.a.facts.name, window.explorer.state.b.facts.name]));
    await page.locator("#map-kind").selectOption("difference");
    await page.waitForFunction(() => /mean ΔE/.test(document.querySelector("#map-value").textContent));
    assert.equal(await page.locator("canvas.disk").last().isVisible(), false);
});

test("channels have curves of their own, which can be enlarged", async () => {
    await close(page);
    const { name, file } = files().find(({ name }) => name.startsWith("paint-"));
    await drop(page, [{ name, file }]);
    const channels = await page.evaluate(() => window.explorer.state.a.facts.channels);
    assert.ok(channels.length > 1 && channels.length <= 8);
    await page.locator("#channel").selectOption("*");
    await page.waitForFunction((count) => document.querySelectorAll("#curves .keys > span").length === count, channels.length);
    assert.deepEqual(await page.locator("#curves .keys > span").allTextContents(), channels);
    const peaks = [...(await readout(page)).matchAll(/([^ ,]+): peak ([\d.e−+]+) 1\/sr/g)];
    assert.deepEqual(peaks.map(([, name]) => name), channels);
    const angle = async (share) => {
        const box = await page.locator("#curve-plot .u-over").boundingBox();
        await page.mouse.move(box.x + share * box.width, box.y + 0.5 * box.height);
        await page.waitForFunction(() => /θ/.test(document.querySelector("#curve-value").textContent));
        return Number(/θ ([\d.−]+)°/.exec(await readout(page))[1].replace("−", "-"));
    };
    const width = async () => (await angle(0.9)) - (await angle(0.1));
    const whole = await width();
    assert.ok(Math.abs(whole - 144) < 3, `${whole}`);
    await page.locator("#curves button[aria-label='Zoom in']").click();
    await page.locator("#curves button[aria-label='Zoom in']").click();
    const part = await width();
    assert.ok(Math.abs(part - whole / 4) < 1.5, `${part}`);
    await page.locator("h1").click();
    await page.keyboard.press("0");
    assert.ok(Math.abs((await width()) - whole) < 3);
    await page.locator("#channel").selectOption("");
});

test("the value of the lobe in space is read at the pointer", async () => {
    const canvas = page.locator("canvas.space");
    await canvas.scrollIntoViewIfNeeded();
    const box = await canvas.boundingBox();
    const found = [];
    for (let step = 0; step < 60; step++) {
        await page.mouse.move(box.x + (0.3 + 0.4 * (step % 10) * 0.1) * box.width, box.y + (0.2 + 0.6 * Math.floor(step / 10) * 0.2) * box.height);
        const text = await page.locator("#space-value").textContent();
        if (text) found.push(text);
    }
    assert.ok(found.length > 2, `${found.length}`);
    const [, theta, phi, value] = /^θ ([\d.]+)°, φ ([\d.]+)°: ([\d.e−]+) 1\/sr$/.exec(found[0]);
    const exact = await page.evaluate(async ([theta, phi]) => {
        const { state, desk } = window.explorer;
        const direction = (theta, phi) => [Math.sin(theta) * Math.cos(phi), Math.sin(theta) * Math.sin(phi), Math.cos(theta)];
        const wi = direction(state.view.sigma, state.view.psi);
        const texel = await desk.evaluate(state.a.desk, Float32Array.from(wi), Float32Array.from(direction(theta, phi)), "", true);
        return [Math.min(...texel), Math.max(...texel)];
    }, [theta, phi].map((angle) => (Number(angle) * Math.PI) / 180));
    // The luminance is between the channels; the angles are rounded.
    assert.ok(Number(value) > 0.8 * exact[0] && Number(value) < 1.25 * exact[1], `${found[0]}: ${exact}`);
});

test("polarisation is shown and exported", async () => {
    await close(page);
    const { name, file } = examples().find(({ word }) => word === "mueller-csv" || word === "pbsdf") ?? {};
    assert.ok(name, "there is an example of Mueller matrices");
    await drop(page, [{ name, file }]);
    await page.waitForFunction(() => document.querySelector("#polarisation svg.figure"));
    const title = () => page.locator("#polarisation svg title").first().textContent();
    assert.match(await title(), /polari[sz]ation/i);
    await page.locator("#polarisation button", { hasText: "Mueller matrix" }).click();
    await page.waitForFunction(() => /Mueller/.test(document.querySelector("#polarisation svg title")?.textContent));
    await page.locator("#map-kind").selectOption("dolp");
    await page.locator("#show-export").click();
    for (const kind of ["mueller", "polarisation"]) {
        const [download] = await Promise.all([page.waitForEvent("download"), page.locator(`#svg-${kind}`).click()]);
        assert.match(readFileSync(await download.path(), "utf8"), /^<svg/);
    }
    await page.keyboard.press("Escape");
    assert.equal(await page.locator(".message.error").count(), 0);
});

test("no other server was asked, and nothing failed unseen", () => {
    assert.deepEqual(asked.filter((url) => !url.startsWith(base) && !url.startsWith("blob:") && !url.startsWith("data:")), []);
    assert.deepEqual(problems, []);
});
