// How much faster simd128 is than scalar code: the module against one that was built without it. In node, whose engine is
// that of Chromium.
import { readFileSync } from "node:fs";
import path from "node:path";
import { pathToFileURL } from "node:url";

import { bytes, differing, files, pairs, rounded, shared } from "./common.mjs";

async function load(folder) {
    const module = await import(pathToFileURL(path.join(folder, "lobe_web.js")).href);
    await module.default({ module_or_path: readFileSync(path.join(folder, "lobe_web_bg.wasm")) });
    return new module.Explorer();
}

const [simd, scalar] = [await load(process.env.LOBE_WEB_MODULE), await load(process.env.LOBE_WEB_SCALAR)];
const { wi, wo } = rounded(pairs(1 << 14, 3));
const WARM = 1500;
const TURNS = 25;
const TIMES = 4;

/** Files whose names are these, and small enough. */
const named = /^(gold|ceramic|tissue|acrylic|vinyl|.*\.(binary|bsdf|xml))/;
const measured = shared().filter(({ name, file }) => named.test(name) && bytes(file).length < 4e7).slice(0, 12);

for (const { name, file } of [...files(), ...measured]) {
    const content = bytes(file);
    const open = (explorer) => {
        explorer.add(name, content.slice());
        return explorer.open(name);
    };
    let contenders;
    try {
        contenders = [
            { what: "simd128", explorer: simd, backend: "simd128", material: open(simd) },
            { what: "scalar backend of the same module", explorer: simd, backend: "scalar", material: open(simd) },
            { what: "scalar module", explorer: scalar, backend: "scalar", material: open(scalar) },
        ];
    } catch {
        continue;
    }
    // Engines begin with code that was compiled in a hurry.
    const answers = contenders.map(({ explorer, backend, material }) => {
        const begun = performance.now();
        while (performance.now() - begun < WARM) explorer.time(material, wi, wo, backend, true, 1, 1);
        return explorer.eval(material, wi, wo, backend, true);
    });
    if (answers.some((answer) => differing(answer, answers[0]) > 0)) throw new Error(`${name}: the values differ`);
    const least = contenders.map(() => Infinity);
    // The shortest of interleaved turns.
    for (let turn = 0; turn < TURNS; turn++) {
        contenders.forEach(({ explorer, backend, material }, at) => {
            least[at] = Math.min(least[at], explorer.time(material, wi, wo, backend, true, TIMES, 1) / TIMES);
        });
    }
    const ns = least.map((time) => (1e6 * time) / (wi.length / 3));
    const rest = contenders.slice(1).map(({ what }, at) => `${(ns[at + 1] / ns[0]).toFixed(2)} times as fast as the ${what}`);
    console.log(`${name}: ${ns[0].toFixed(0)} ns per pair, ${rest.join(", ")}`);
}
