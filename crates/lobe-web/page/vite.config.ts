import { fileURLToPath } from "node:url";

import { defineConfig } from "vite";

// `cargo xtask web` sets where the module is that wasm-bindgen has made, and where the page is written.
declare const process: { env: Record<string, string | undefined> };
const module = process.env.LOBE_WEB_MODULE ?? fileURLToPath(new URL("../../../target/web-module", import.meta.url));

export default defineConfig({
    // The page works in any folder of any server.
    base: "./",
    resolve: {
        alias: [
            { find: /^lobe-web\/wasm/, replacement: `${module}/lobe_web_bg.wasm` },
            { find: /^lobe-web$/, replacement: `${module}/lobe_web.js` },
        ],
    },
    build: {
        outDir: process.env.LOBE_WEB_OUT ?? "dist",
        emptyOutDir: true,
        target: "es2022",
        assetsInlineLimit: 0,
        modulePreload: false,
    },
    worker: { format: "es" },
    server: { fs: { strict: false } },
});
