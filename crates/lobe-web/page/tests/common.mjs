// What both tests share: the program, the fixtures, and pairs of directions.
import { execFileSync } from "node:child_process";
import { mkdtempSync, readdirSync, readFileSync, statSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { fileURLToPath } from "node:url";

export const root = fileURLToPath(new URL("../../../..", import.meta.url));
export const lobe = process.env.LOBE ?? path.join(root, "target/debug/lobe");
export const scratch = mkdtempSync(path.join(tmpdir(), "lobe-web-"));

export const run = (...args) => execFileSync(lobe, args, { cwd: scratch, maxBuffer: 1 << 28, encoding: "utf8", stdio: ["ignore", "pipe", "pipe"] });

/** The fixtures, and the same materials in other representations, made by the program. */
let made;
export function files() {
    return (made ??= make());
}

function make() {
    const fixtures = path.join(root, "fixtures");
    const found = readdirSync(fixtures).filter((name) => name.endsWith(".ddr")).map((name) => ({ name, file: path.join(fixtures, name) }));
    const add = (name, ...args) => {
        run(...args, name);
        found.push({ name, file: path.join(scratch, name) });
    };
    add("rough.bsdf", "generate", "ggx", "--to", "rgl", "--alpha", "0.3", "--zeniths", "8", "--texels", "16");
    add("paint.xml", "convert", "--to", "klems", path.join(fixtures, "conductor-7x8x13.ddr"));
    add("paint.binary", "convert", path.join(fixtures, "conductor-7x8x13.ddr"));
    return found;
}

/** A small file of every format, written by the tests of the libraries. */
export function examples() {
    const folder = process.env.LOBE_WEB_EXAMPLES ?? path.join(root, "target/web-examples");
    const names = readdirSync(folder).sort();
    return names.map((name) => ({ name, word: /^(.*)-\d+\./.exec(name)[1], file: path.join(folder, name) }));
}

/** Real files of all formats, where the project keeps them; none elsewhere. */
export function shared() {
    const folder = process.env.LOBE_SHARED ?? path.join(root, "../shared");
    const found = [];
    const walk = (inside) => {
        for (const entry of readdirSync(inside, { withFileTypes: true })) {
            const file = path.join(inside, entry.name);
            if (entry.isDirectory()) walk(file);
            else found.push({ name: entry.name, file });
        }
    };
    try {
        walk(path.join(folder, "data"));
    } catch {
        return [];
    }
    return found;
}

/** Directions above the surface, the same at every call, a tenth of the viewers below it. */
export function pairs(count, seed = 1) {
    let state = seed >>> 0;
    const random = () => {
        state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
        return state / 2 ** 32;
    };
    const direction = (below) => {
        const z = below * random();
        const [radius, azimuth] = [Math.sqrt(1 - z * z), 2 * Math.PI * random()];
        return [radius * Math.cos(azimuth), radius * Math.sin(azimuth), z];
    };
    return Array.from({ length: count }, () => [...direction(1), ...direction(random() < 0.1 ? -1 : 1)]);
}

const tables = new Map();

/** The file with those pairs. */
function table(all) {
    if (!tables.has(all)) {
        const file = path.join(scratch, `pairs-${tables.size}.csv`);
        writeFileSync(file, all.map((pair) => pair.join(",")).join("\n"));
        tables.set(all, file);
    }
    return tables.get(all);
}

/** What the program says: the values of the pairs as 32-bit floats, in strict form. */
export function expected(file, all) {
    const words = run("eval", file, "--pairs", table(all), "--strict").trim().split(/[\n,]/);
    return Float32Array.from(words, (word) => Number(word === "inf" ? "Infinity" : word));
}

/** How large a file is. */
export const size = (file) => statSync(file).size;

/** The directions as the program rounds them. */
export function rounded(all) {
    const unit = (...components) => {
        const largest = Math.max(...components.map(Math.abs));
        const [x, y, z] = components.map((c) => c / largest);
        const length = Math.sqrt(x * x + y * y + z * z);
        return [x / length, y / length, z / length];
    };
    return {
        wi: Float32Array.from(all.flatMap(([x, y, z]) => unit(x, y, z))),
        wo: Float32Array.from(all.flatMap(([, , , x, y, z]) => unit(x, y, z))),
    };
}

/** How many floats differ in a bit; NaN equals NaN. */
export function differing(a, b) {
    if (a.length !== b.length) return Math.max(a.length, b.length);
    const [x, y] = [new Uint32Array(a.buffer, a.byteOffset, a.length), new Uint32Array(b.buffer, b.byteOffset, b.length)];
    let count = 0;
    for (let at = 0; at < x.length; at++) if (x[at] !== y[at] && !(Number.isNaN(a[at]) && Number.isNaN(b[at]))) count++;
    return count;
}

export const bytes = (file) => new Uint8Array(readFileSync(file));
