// The state of the page, and the link that restores it.

export interface SideFacts {
    side: string;
    scatters: string[];
    psi: number;
    sigmas: number[];
}

export interface FileFacts {
    name: string;
    path: string;
    format: string;
    bytes: number;
    kind: string;
    channels: string[];
    wavelengths: number[] | null;
    quantity: string;
    has_colour: boolean;
    is_polarised: boolean;
    is_isotropic: boolean;
    sides: SideFacts[];
    parts: { name: string; rows: [string, string][] }[];
    source: [string, string][];
    notes: string[];
    doubts: string[];
}

export interface Finding {
    check: string;
    part: string;
    status: "pass" | "note" | "warn" | "fail";
    text: string;
}

export interface Material {
    /** The number of the material in the worker for the views, and in the one for pictures and checks, if open there. */
    desk: number;
    studio: number | undefined;
    path: string;
    /** Kept to open the material in the second worker, or in a worker that was restarted. */
    files: { path: string; bytes: Uint8Array }[];
    facts: FileFacts;
    findings: Finding[] | undefined;
}

export interface View {
    side: string;
    scatter: string;
    channel: string;
    scale: "log" | "linear";
    /** The direction of the light, in radians. */
    sigma: number;
    psi: number;
    chart: "curve" | "polar";
    map: "values" | "colours" | "dolp" | "difference";
    stokes: "polarisation" | "mueller";
    form: "ball" | "cloth" | "flat";
    sky: "studio" | "overcast" | "dusk" | "dark";
    lamp: [number, number, number];
    exposure: number;
}

export const DEGREE = Math.PI / 180;
/** The largest polar angle of the light; beyond it, the horizon matters more than the material. */
export const LOWEST = 88 * DEGREE;

/** In place of the name of a channel: each in curves of its own. */
export const EACH = "*";
/** `true` if there are few enough channels for curves of each. */
export const isFew = (channels: string[]): boolean => channels.length > 1 && channels.length <= 8;

export class State {
    materials: Material[] = [];
    /** The material that is shown, and the one that it is compared with. */
    a: Material | undefined;
    b: Material | undefined;
    view: View = {
        side: "front",
        scatter: "reflection",
        channel: "",
        scale: "log",
        sigma: 30 * DEGREE,
        psi: 0,
        chart: "curve",
        map: "values",
        stokes: "polarisation",
        form: "ball",
        sky: "studio",
        lamp: [-0.55, 0.62, 0.56],
        exposure: 0,
    };
    /** `true` if the user has set the angle; otherwise it is one at which the material was measured. */
    chosen = { sigma: false, psi: false };
    private listeners: ((what: string) => void)[] = [];

    /** Registers a callback for changes: `light`, `lamp`, `exposure`, `view`, `picture` or `materials`. */
    listen(listener: (what: string) => void): void {
        this.listeners.push(listener);
    }

    changed(what: string): void {
        for (const listener of this.listeners) listener(what);
        saveLink(this);
    }

    set(change: Partial<View>, what = "view"): void {
        Object.assign(this.view, change);
        if (change.sigma !== undefined) this.chosen.sigma = true;
        if (change.psi !== undefined) this.chosen.psi = true;
        this.changed(what);
    }

    /** The request to the module, as JSON. Of a channel that the material does not have, all are reduced to one value. */
    request(material: Material | undefined = this.a, channel = this.view.channel): string {
        const { side, scatter, psi, scale } = this.view;
        const hasChannel = material?.facts.channels.includes(channel) ?? false;
        return JSON.stringify({ side, scatter, psi, scale, channel: hasChannel ? channel : "" });
    }

    /** Shows a material, and keeps as much of the view as it has data for. */
    show(material: Material | undefined): void {
        this.a = material;
        if (this.b === material) this.b = undefined;
        if (material) {
            const { view } = this;
            const sides = material.facts.sides;
            const side = sides.find((side) => side.side === view.side) ?? sides[0];
            if (side) {
                if (side.side !== view.side || !this.chosen.psi) view.psi = side.psi;
                if (!this.chosen.sigma && side.sigmas.length > 0) {
                    const start = 35 * DEGREE;
                    view.sigma = side.sigmas.reduce((best, at) => (Math.abs(at - start) < Math.abs(best - start) ? at : best));
                }
                view.side = side.side;
                if (!side.scatters.includes(view.scatter)) view.scatter = side.scatters[0];
            }
            const { channels } = material.facts;
            if (!channels.includes(view.channel) && (view.channel !== EACH || !isFew(channels))) view.channel = "";
            if (view.map === "dolp" && !material.facts.is_polarised) view.map = "values";
        }
        if (!this.b && this.view.map === "difference") this.view.map = "values";
        this.changed("materials");
    }
}

const WORDS: Partial<Record<keyof View, readonly string[]>> = {
    side: ["front", "back"],
    scatter: ["reflection", "transmission"],
    scale: ["log", "linear"],
    chart: ["curve", "polar"],
    map: ["values", "colours", "dolp", "difference"],
    stokes: ["polarisation", "mueller"],
    form: ["ball", "cloth", "flat"],
    sky: ["studio", "overcast", "dusk", "dark"],
};

let timer = 0;
function saveLink(state: State): void {
    clearTimeout(timer);
    timer = window.setTimeout(() => history.replaceState(null, "", `#${link(state)}`), 200);
}

/** The view and the paths of the files, without their contents. */
export function link(state: State): string {
    const { view } = state;
    const words = new URLSearchParams();
    for (const key of Object.keys(WORDS) as (keyof View)[]) words.set(key, String(view[key]));
    words.set("channel", view.channel);
    words.set("sigma", (view.sigma / DEGREE).toFixed(2));
    words.set("psi", (view.psi / DEGREE).toFixed(2));
    words.set("lamp", view.lamp.map((c) => c.toFixed(3)).join(","));
    words.set("exposure", String(view.exposure));
    if (state.a) words.set("a", state.a.path);
    if (state.b) words.set("b", state.b.path);
    return words.toString();
}

/** Restores the view of a link, ignoring invalid values. Returns the paths of the files that it showed. */
export function restore(state: State, hash: string): { a: string; b: string } {
    const words = new URLSearchParams(hash.replace(/^#/, ""));
    if (words.size === 0) return { a: "", b: "" };
    const view = state.view as unknown as Record<string, unknown>;
    for (const [key, known] of Object.entries(WORDS)) {
        const word = words.get(key);
        if (word !== null && known.includes(word)) view[key] = word;
    }
    state.view.channel = words.get("channel") ?? "";
    const number = (key: string, least: number, most: number): number | undefined => {
        const value = Number(words.get(key) ?? NaN);
        return value >= least && value <= most ? value : undefined;
    };
    const sigma = number("sigma", 0, 88);
    const psi = number("psi", -360, 360);
    if (sigma !== undefined) [state.view.sigma, state.chosen.sigma] = [sigma * DEGREE, true];
    if (psi !== undefined) [state.view.psi, state.chosen.psi] = [psi * DEGREE, true];
    state.view.exposure = number("exposure", -8, 8) ?? 0;
    const lamp = (words.get("lamp") ?? "").split(",").map(Number);
    if (lamp.length === 3 && lamp.every(Number.isFinite) && Math.hypot(...lamp) > 0) state.view.lamp = lamp as [number, number, number];
    return { a: words.get("a") ?? "", b: words.get("b") ?? "" };
}
