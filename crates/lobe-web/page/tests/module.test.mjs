// The module in node, against the program.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import path from "node:path";
import { before, test } from "node:test";
import { pathToFileURL } from "node:url";

import { bytes, differing, examples, expected, files, lobe, pairs, rounded, run, scratch, shared, size } from "./common.mjs";

const folder = process.env.LOBE_WEB_MODULE;
let explorer;
let Explorer;

before(async () => {
    const module = await import(pathToFileURL(path.join(folder, "lobe_web.js")).href);
    await module.default({ module_or_path: readFileSync(path.join(folder, "lobe_web_bg.wasm")) });
    ({ Explorer } = module);
    explorer = new Explorer();
});

function open(name, content) {
    explorer.add(name, content);
    try {
        return explorer.open(name);
    } finally {
        explorer.remove(name);
    }
}

const PAIRS = 100_000;
/** The representations that have values for pairs of directions. */
const KINDS = ["specular table", "spherical grid", "half-difference grid", "UTIA grid", "RGL", "Mueller matrices", "specular Mueller matrices", "Zernike expansion", "cosine series", "Klems matrices", "tensor trees", "scattered samples", "sheet"];

/** The values of a file on every backend against those of the program, bit by bit, or its refusal against that of the program. */
function compare(name, file, all) {
    const { wi, wo } = rounded(all);
    let answer;
    let refusal = "";
    try {
        answer = expected(file, all);
    } catch (error) {
        refusal = String(error.stderr);
    }
    let material;
    try {
        material = open(name, bytes(file));
    } catch (error) {
        // The program names the whole path.
        assert.ok(refusal.includes(error.message.slice(name.length, name.length + 60)), `${file}: ${error.message} but ${refusal}`);
        return { refusal: error.message, kinds: [], channels: 0, some: false };
    }
    assert.equal(refusal, "", `${file} opens here`);
    for (const backend of Explorer.backends().split(",")) {
        assert.equal(differing(explorer.eval(material, wi, wo, backend, true), answer), 0, `${file} on ${backend}`);
    }
    const { kind, parts } = JSON.parse(explorer.facts(material));
    explorer.close(material);
    const kinds = [kind, ...parts.map(({ rows }) => rows.find(([name]) => name === "kind")[1])];
    return { refusal: "", kinds, channels: answer.length / all.length, some: answer.some((f) => f > 0) };
}

test("values of every representation are those of the program, bit by bit", (context) => {
    const all = pairs(PAIRS);
    const seen = new Set();
    for (const { name, file } of [...files(), ...examples()]) {
        const { kinds, some } = compare(name, file, all);
        // Some examples were measured in a plane only.
        if (some) for (const kind of kinds) seen.add(kind);
    }
    context.diagnostic([...seen].sort().join(", "));
    for (const kind of KINDS) assert.ok(seen.has(kind), kind);
});

test("every format that the program reads opens", () => {
    const opened = new Set();
    for (const { name, word, file } of examples()) {
        const whole = bytes(file);
        try {
            explorer.close(open(name, whole));
            opened.add(word);
        } catch (error) {
            // Mirrors have no value for a pair of directions, and some of these files have sides with different channels.
            assert.match(error.message, /mirror reflectance|parts with different channels/, name);
        }
    }
    const words = new Set(examples().map(({ word }) => word));
    assert.ok(words.size >= 26, `${words.size}`);
    assert.deepEqual([...words].filter((word) => !opened.has(word)), ["sdr", "ssdd"]);
});

test("files have the values of the program, or are refused with its messages", (context) => {
    const found = shared();
    if (found.length === 0) return context.skip("there are no measured files");
    const few = pairs(300, 7);
    const counts = { same: 0, refused: 0 };
    // The largest file of each representation, of those whose values are not too many to be written as text.
    const most = 30;
    const largest = new Map();
    for (const { name, file } of found) {
        const { refusal, kinds, channels } = compare(name, file, few);
        counts[refusal ? "refused" : "same"]++;
        if (refusal) continue;
        const what = kinds.slice(0, 2).join(": ");
        const rank = channels <= most ? size(file) : -channels;
        if (rank > (largest.get(what)?.rank ?? -Infinity)) largest.set(what, { file, rank, channels });
    }
    const all = pairs(PAIRS, 11);
    for (const { file, channels } of largest.values()) {
        const some = channels <= most ? all : all.slice(0, Math.ceil((PAIRS * most) / channels));
        assert.equal(compare(path.basename(file), file, some).refusal, "");
    }
    const names = [...largest].map(([what, { file, channels }]) => `${what} (${path.basename(file)}, ${channels} channels)`).join("; ");
    context.diagnostic(`${counts.same} files with the same bits, ${counts.refused} refused alike, of ${found.length}. At ${PAIRS} pairs, fewer of more than ${most} channels: ${names}`);
});

test("damaged files are refused with the messages of the program", () => {
    const [{ name, file }] = files();
    const whole = bytes(file);
    let refused = 0;
    for (const share of [0.05, 0.4, 0.77, 0.999]) {
        const damaged = whole.slice(0, Math.floor(share * whole.length));
        writeFileSync(path.join(scratch, name), damaged);
        let said = "";
        try {
            execFileSync(lobe, ["info", name], { cwd: scratch, stdio: "pipe" });
        } catch (error) {
            said = String(error.stderr).trim();
        }
        if (!said) continue;
        refused++;
        assert.throws(() => open(name, damaged), (error) => `error: ${error.message}` === said);
    }
    assert.ok(refused >= 2);
});

test("curves, maps, probes and facts agree with values", () => {
    const { name, file } = files().find(({ name }) => name.startsWith("cloth"));
    const material = open(name, bytes(file));
    const facts = JSON.parse(explorer.facts(material));
    assert.equal(facts.format, "Integra DDR/DDT");
    const request = JSON.stringify({ side: "front", psi: 0.3, channel: facts.channels[0] });
    const curve = explorer.curve(material, request, 0.5);
    assert.ok(curve.length > 3000 && curve.length % 3 === 0);
    const size = 32;
    const map = explorer.map(material, request, 0.5, size, "values", 0, new Float64Array());
    const [x, y] = [20, 9];
    const probe = JSON.parse(explorer.probe(material, request, 0.5, (2 * (x + 0.5)) / size - 1, 1 - (2 * (y + 0.5)) / size));
    assert.equal(Math.fround(probe.value), map.values[y * size + x]);
    const [value] = explorer.eval(material, Float32Array.from(probe.wi), Float32Array.from(probe.wo), "", false);
    assert.equal(Math.fround(probe.channels[0]), value);
    // The same for half and difference angles: a pixel, the value at its centre, and that of its directions.
    const half = explorer.half(material, request, size);
    const at = JSON.parse(explorer.half_probe(material, request, (x + 0.5) / size, 1 - (y + 0.5) / size));
    assert.ok(Math.abs(at.value / half.values[y * size + x] - 1) < 1e-4, `${at.value} ${half.values[y * size + x]}`);
    const turned = (across) => {
        const [along, z] = [Math.cos(at.theta_d) * Math.sin(at.theta_h), Math.cos(at.theta_d) * Math.cos(at.theta_h)];
        return Float32Array.of(along * Math.cos(0.3) - across * Math.sin(0.3), along * Math.sin(0.3) + across * Math.cos(0.3), z);
    };
    const [there] = explorer.eval(material, turned(Math.sin(at.theta_d)), turned(-Math.sin(at.theta_d)), "", false);
    assert.ok(Math.abs(at.value / there - 1) < 1e-4, `${at.value} ${there}`);
    assert.equal(JSON.parse(explorer.half_probe(material, request, 1.1, 0.5)), null);
    assert.throws(() => explorer.curve(material, '{"side": "back"}', 0.5), /found no values for light from the back/);
    assert.throws(() => explorer.curve(material, "{", 0.5), /expected JSON/);
    assert.throws(() => explorer.facts(99), /found no material 99/);
    explorer.close(material);
});

test("findings of the checks are those of the program", () => {
    const { name, file } = files().find(({ name }) => name.startsWith("conductor"));
    const material = open(name, bytes(file));
    const found = JSON.parse(explorer.findings(material, false));
    let json;
    try {
        json = run("check", "--json", file);
    } catch (error) {
        json = error.stdout;
    }
    const [{ findings }] = JSON.parse(json);
    assert.deepEqual(found.map(({ check, status }) => [check, status]), findings.map(({ check, status }) => [check, status]));
    explorer.close(material);
});

test("a picture is rendered in steps, and a converted file has the same values", () => {
    const { name, file } = files().find(({ name }) => name.startsWith("paint-"));
    const material = open(name, bytes(file));
    explorer.stage(0, material, JSON.stringify({ form: "flat", sky: "dusk", toward: [0, 1, 0.3], size: [48, 48], samples: 2 }));
    let calls = 0;
    while (!explorer.rendered(0) && calls < 100) {
        explorer.render(0, 5);
        calls++;
    }
    const picture = explorer.picture(0, 0);
    assert.throws(() => explorer.picture(2, 0), /found the stage 2/);
    assert.equal(picture.length, 4 * 48 * 48);
    assert.ok(picture.some((byte, at) => at % 4 < 3 && byte > 60));
    const ball = explorer.ball(material, "{}", 64, Float32Array.of(-0.5, 0.5, 0.7), 0);
    assert.ok(ball[4 * (64 * 20 + 20)] > 0);
    const target = JSON.parse(explorer.targets(material)).find(({ word, is_exact }) => is_exact && word === "ssdd");
    const written = explorer.convert(material, target.word, "");
    const again = open(written.name, written.bytes);
    const { wi, wo } = rounded(pairs(500));
    assert.equal(differing(explorer.eval(material, wi, wo, "", true), explorer.eval(again, wi, wo, "", true)), 0);
    assert.throws(() => explorer.convert(material, "rgl", ""), /lobe convert/);
});

test("simd128 against scalar", (context) => {
    const { wi, wo } = rounded(pairs(1 << 15, 3));
    for (const { name, file } of files()) {
        const material = open(name, bytes(file));
        const least = { scalar: Infinity, simd128: Infinity };
        // The shortest of interleaved turns.
        for (let turn = 0; turn < 7; turn++) {
            for (const backend of Object.keys(least)) {
                const begun = performance.now();
                explorer.eval(material, wi, wo, backend, true);
                least[backend] = Math.min(least[backend], performance.now() - begun);
            }
        }
        const ns = (1e6 * least.simd128) / (wi.length / 3);
        context.diagnostic(`${name}: ${(least.scalar / least.simd128).toFixed(2)} times, ${ns.toFixed(0)} ns per pair`);
        explorer.close(material);
    }
});
