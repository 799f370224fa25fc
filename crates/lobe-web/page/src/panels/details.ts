// Albedos, spectra, and the difference between two materials.
import uPlot from "uplot";

import { colour, degrees, h, panel, short } from "../dom";
import { type Engine, Latest } from "../engine";
import type { Material, State } from "../state";

interface Spectrum {
    theta: number;
    nm: number[];
    f: number[];
}

interface Compared {
    difference: { channels: string[]; pairs: number; peak: number; max: number; rms: number; relative_rms: number; bias: number };
    visible: { mean: number; percentile_95: number; max: number };
}

const axis = () => ({ stroke: colour("quiet"), grid: { stroke: colour("line"), width: 1 }, ticks: { stroke: colour("line"), width: 1 }, font: "12px system-ui, sans-serif" });

export class Details {
    readonly albedo: HTMLElement;
    readonly spectrum: HTMLElement;
    readonly compare: HTMLElement;
    private readonly table = h("table", { class: "numbers" });
    private readonly plot = h("div", { class: "plot" });
    private readonly numbers = h("dl", { class: "compared", id: "compared" });
    private chart: uPlot | undefined;
    private readonly latest: { albedo: Latest; spectrum: Latest; compare: Latest };

    /** Integrals take long, so they are left to the second worker, `slow`; `ready` opens a material there. */
    constructor(
        private readonly engine: Engine,
        private readonly slow: Engine,
        private readonly state: State,
        private readonly ready: (material: Material) => Promise<number>,
        onError: (error: Error) => void,
    ) {
        this.latest = { albedo: new Latest(onError), spectrum: new Latest(onError), compare: new Latest(onError) };
        const ratio = h("p", { class: "hint" }, "The integral of f cos θ over the hemisphere: the share of the light from σ that is scattered.");
        this.albedo = panel("albedo", "Directional albedo", [], this.table, ratio);
        this.spectrum = panel("spectrum", "Spectra", [], this.plot, h("p", { class: "hint" }, "At the mirror direction, and 5°, 20° and 45° from it toward the light."));
        this.compare = panel("compare", "Difference", [], this.numbers, h("p", { class: "hint" }, "ΔE is CIE delta E 2000 of two spheres under one light; about 1 is just noticeable."));
    }

    /** Updates everything, including albedos and differences, which do not depend on the light. */
    update(): void {
        const { a, b } = this.state;
        this.spectrum.hidden = (a?.facts.wavelengths?.length ?? 0) < 2;
        this.compare.hidden = !b;
        if (!a) return;
        this.light();
        const request = this.state.request(a);
        this.latest.albedo.run(async () => {
            const side = a.facts.sides.find((side) => side.side === this.state.view.side);
            const sigmas = new Float64Array(side?.sigmas ?? []);
            const rows = await this.slow.albedos(await this.ready(a), request, sigmas);
            this.showAlbedos(rows);
        }, () => this.state.a === a);
        if (!b) return;
        this.latest.compare.run(async () => {
            this.numbers.replaceChildren(h("dt", {}, "Comparing…"));
            const { difference, visible } = JSON.parse(await this.engine.compare(a.desk, b.desk, request)) as Compared;
            const rows: [string, string][] = [
                ["ΔE, mean", short(visible.mean)],
                ["ΔE, 95th percentile", short(visible.percentile_95)],
                ["ΔE, largest", short(visible.max)],
                ["rms", `${short(difference.rms)} 1/sr, ${short(100 * difference.relative_rms)} % of the values of A`],
                ["largest", `${short(difference.max)} 1/sr, where the peak of A is ${short(difference.peak)}`],
                ["bias", `${short(difference.bias)} 1/sr (B minus A)`],
                ["compared in", `${difference.channels.slice(0, 6).join(" ")}, at ${difference.pairs} pairs of directions`],
            ];
            this.numbers.replaceChildren(...rows.flatMap(([name, value]) => [h("dt", {}, name), h("dd", {}, value)]));
        }, () => this.state.a === a && this.state.b === b);
    }

    private showAlbedos(rows: Float64Array): void {
        const ROW = 5;
        if (rows.length === 0) {
            this.table.replaceChildren(h("tbody", {}, h("tr", {}, h("td", {}, "No albedo: only the plane of incidence was measured."))));
            return;
        }
        const row = (at: number) => {
            const [sigma, value, r, g, b] = rows.subarray(ROW * at, ROW * at + ROW);
            // The swatch is drawn by the browser from linear values.
            const swatch = h("span", { class: "swatch", style: `background: color(srgb-linear ${r} ${g} ${b})` });
            const width = `width: ${Math.min(100, Math.max(0, 100 * value)).toFixed(1)}%`;
            return h("tr", {}, h("th", { scope: "row" }, degrees(sigma)), h("td", {}, short(value)), h("td", {}, swatch), h("td", { class: "wide" }, h("span", { class: "share", style: width })));
        };
        this.table.replaceChildren(
            h("thead", {}, h("tr", {}, h("th", { scope: "col" }, "σ"), h("th", { scope: "col" }, "albedo"), h("th", { scope: "col" }, "colour"), h("th", { scope: "col" }, "0 to 1"))),
            h("tbody", {}, ...Array.from({ length: rows.length / ROW }, (_, at) => row(at))),
        );
    }

    /** Updates what depends on the light. */
    light(): void {
        const { a } = this.state;
        if (!a || this.spectrum.hidden) return;
        const [request, { sigma }] = [this.state.request(a), this.state.view];
        this.latest.spectrum.run(async () => {
            const text = await this.engine.spectra(a.desk, request, sigma, new Float64Array());
            this.showSpectra(JSON.parse(text) as Spectrum[]);
        }, () => this.state.a === a);
    }

    private showSpectra(spectra: Spectrum[]): void {
        this.chart?.destroy();
        this.chart = undefined;
        if (spectra.length === 0) return;
        const isLog = this.state.view.scale === "log";
        const values = spectra.map(({ f }) => f.map((value) => (isLog && value <= 0 ? null : value)));
        const tones = ["a", "c", "d", "b"];
        const width = Math.max(220, this.plot.clientWidth);
        this.chart = new uPlot(
            {
                width,
                height: Math.round(Math.min(320, Math.max(220, 0.5 * width))),
                scales: { x: { time: false }, y: isLog ? { distr: 3 } : {} },
                axes: [{ ...axis(), label: "nm", labelSize: 18, size: 32 }, { ...axis(), values: (_, ticks) => ticks.map((tick) => (tick === null ? "" : short(tick))), size: 62 }],
                series: [
                    { label: "nm", value: (_: uPlot, nm: number | null) => (nm === null ? "–" : short(nm)) },
                    ...spectra.map(({ theta }, at) => ({
                        label: `θ ${degrees(theta)}`,
                        stroke: colour(tones[at % tones.length]),
                        width: 2,
                        points: { show: false },
                        value: (_: uPlot, value: number | null) => (value === null ? "–" : short(value)),
                    })),
                ],
            },
            [spectra[0].nm, ...values],
            this.plot,
        );
    }
}

