// The page in Chromium, for tests of it.
import { createReadStream, mkdtempSync, readFileSync, rmSync, statSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import path from "node:path";
import { after, before } from "node:test";

import { chromium } from "playwright-core";

export const out = process.env.LOBE_WEB_OUT;
const TYPES = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".wasm": "application/wasm" };

let server;
let profile;
/** The address of the page, the browser, and the page in it. */
export let base;
export let context;
export let page;
/** What was requested, and what went wrong. */
export const asked = [];
export const problems = [];

before(async () => {
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

/** Another tab with the page. */
export async function fresh(url = base) {
    const page = await context.newPage();
    page.on("request", (request) => asked.push(request.url()));
    page.on("pageerror", (error) => problems.push(String(error)));
    page.on("console", (message) => message.type() === "error" && problems.push(message.text()));
    await page.goto(url);
    await page.waitForFunction(() => document.documentElement.dataset.ready !== undefined, undefined, { timeout: 60_000 });
    return page;
}

/** Drops files as a hand would: by the event, with their content. */
export async function drop(page, list) {
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

export const readout = (page) => page.locator("#curve-value").textContent();
export const close = async (page) => {
    const buttons = page.locator(".materials button[aria-label^=Close]");
    while ((await buttons.count()) > 0) await buttons.first().click();
};
