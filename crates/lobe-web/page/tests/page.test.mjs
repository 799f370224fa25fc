// Files in the page: dropped, chosen, served, damaged.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import path from "node:path";
import { test } from "node:test";

import { asked, base, close, context, drop, fresh, out, page, problems } from "./browser.mjs";
import { bytes, differing, examples, expected, files, lobe, pairs, rounded, scratch } from "./common.mjs";

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

test("files and folders are dropped by the browser itself", async () => {
    await close(page);
    const folder = path.join(scratch, "dropped");
    mkdirSync(folder, { recursive: true });
    for (const { name, file } of files().slice(0, 2)) writeFileSync(path.join(folder, name), readFileSync(file));
    const client = await context.newCDPSession(page);
    const opens = await page.evaluate(() => window.explorer.took().opens);
    const data = { items: [], files: [folder, files()[2].file], dragOperationsMask: 1 };
    for (const type of ["dragEnter", "dragOver", "drop"]) await client.send("Input.dispatchDragEvent", { type, x: 400, y: 300, data });
    await page.waitForFunction((opens) => window.explorer.took().opens > opens, opens);
    const names = await page.evaluate(() => window.explorer.state.materials.map(({ facts }) => facts.name).sort());
    assert.deepEqual(names, files().slice(0, 3).map(({ name }) => name).sort());
    await client.detach();
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
    // Another link in the same page.
    await again.evaluate(() => (location.hash = location.hash.replace(/sigma=[\d.]+/, "sigma=40.00").replace("chart=polar", "chart=curve")));
    await again.waitForFunction(() => Math.abs(window.explorer.state.view.sigma - (40 * Math.PI) / 180) < 1e-3 && window.explorer.state.view.chart === "curve");
    await again.close();
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

test("no other server was asked, and nothing failed unseen", () => {
    assert.deepEqual(asked.filter((url) => !url.startsWith(base) && !url.startsWith("blob:") && !url.startsWith("data:")), []);
    assert.deepEqual(problems, []);
});
