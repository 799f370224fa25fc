// Values in the plane of incidence, Cartesian and polar. Dragging moves the light.
import uPlot from "uplot";

import { choice, colour, degrees, fit, h, panel, short } from "../dom";
import { type Engine, Latest } from "../engine";
import { DEGREE, LOWEST, type Material, type State } from "../state";

interface Curve {
    theta: Float64Array;
    f: Float64Array;
    flags: Float64Array;
}

const ROW = 3;

function unpacked(rows: Float64Array): Curve {
    const count = rows.length / ROW;
    const column = (at: number) => Float64Array.from({ length: count }, (_, row) => rows[ROW * row + at]);
    return { theta: column(0), f: column(1), flags: column(2) };
}

export class Curves {
    readonly element: HTMLElement;
    /** How long the last curve took, in milliseconds. */
    took = 0;
    private readonly body = h("div", { class: "plot", id: "curve-plot" });
    private readonly canvas = h("canvas", { class: "polar", hidden: true, tabindex: 0, "aria-label": "Lobe in polar coordinates" });
    private readonly readout = h("output", { class: "readout", id: "curve-value" });
    private readonly kind;
    private plot: uPlot | undefined;
    private curves: { material: Material; curve: Curve }[] = [];
    private shape = "";
    private readonly latest: Latest;

    constructor(private readonly engine: Engine, private readonly state: State, onError: (error: Error) => void) {
        this.latest = new Latest(onError);
        const kinds = [{ value: "curve", text: "Curve" }, { value: "polar", text: "Polar" }] as const;
        this.kind = choice("Coordinates", kinds, () => state.view.chart, (chart) => state.set({ chart }));
        const hint = h("p", { class: "hint" }, "Drag to move the light. Viewing angles are positive away from it.");
        this.element = panel("curves", "In the plane of incidence", [this.kind], this.body, this.canvas, this.readout, hint);
        this.follow(this.canvas, (event) => this.polarAngle(event));
        new ResizeObserver(() => this.resize()).observe(this.body.parentElement ?? this.body);
        matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.redraw(true));
    }

    update(): void {
        this.kind.update();
        const { a, b } = this.state;
        if (!a) return;
        this.latest.run(async () => {
            const begun = performance.now();
            const materials = b ? [a, b] : [a];
            const { sigma } = this.state.view;
            const curve = async (material: Material) => ({
                material,
                curve: unpacked(await this.engine.curve(material.desk, this.state.request(material), sigma)),
            });
            this.curves = await Promise.all(materials.map(curve));
            this.redraw();
            this.took = performance.now() - begun;
        });
    }

    /** Redraws the curves. The chart is rebuilt if something other than the values has changed, or if `anew`. */
    redraw(anew = false): void {
        const { chart, scale } = this.state.view;
        const isPolar = chart === "polar";
        this.body.hidden = isPolar;
        this.canvas.hidden = !isPolar;
        if (this.curves.length === 0) return;
        if (isPolar) {
            this.drawPolar();
            return;
        }
        const shape = `${scale} ${this.curves.map(({ material }) => material.path).join("|")}`;
        if (anew || shape !== this.shape || !this.plot) this.make(shape);
        this.plot?.setData(this.data());
        // The readout must follow the new values even if the pointer does not move.
        if (this.plot) this.say(this.plot);
    }

    private data(): uPlot.AlignedData {
        const isLog = this.state.view.scale === "log";
        const tables = this.curves.map(({ curve }): uPlot.AlignedData => {
            const x = Array.from(curve.theta, (theta) => theta / DEGREE);
            const value = (flag: (flags: number) => boolean) =>
                Array.from(curve.f, (f, at) => (flag(curve.flags[at]) && (!isLog || f > 0) ? f : null));
            return [x, value(() => true), value((flags) => flags >= 1), value((flags) => flags >= 2)];
        });
        return tables.length === 1 ? tables[0] : uPlot.join(tables);
    }

    private make(shape: string): void {
        this.plot?.destroy();
        this.shape = shape;
        const axis = { stroke: colour("quiet"), grid: { stroke: colour("line"), width: 1 }, ticks: { stroke: colour("line"), width: 1 }, font: "12px system-ui, sans-serif" };
        const series: uPlot.Series[] = [{}];
        for (const [at] of this.curves.entries()) {
            const stroke = colour(at === 0 ? "a" : "b");
            series.push({ stroke, width: 1, dash: [3, 4], points: { show: false }, spanGaps: false });
            series.push({ stroke, width: 2, points: { show: false }, spanGaps: false });
            series.push({ stroke, width: 0, paths: () => null, points: { show: true, size: 5, fill: stroke, stroke }, spanGaps: false });
        }
        const isLog = this.state.view.scale === "log";
        this.plot = new uPlot(
            {
                ...this.room(),
                legend: { show: false },
                cursor: { drag: { x: false, y: false }, points: { show: false }, y: false },
                scales: {
                    x: { time: false, range: [-90, 90] },
                    y: isLog ? { distr: 3, range: (_, low, high) => decades(low, high) } : { range: (_, low, high) => [Math.min(0, low ?? 0), (high || 1) * 1.06] },
                },
                axes: [
                    { ...axis, values: (_, ticks) => ticks.map((tick) => `${String(tick).replace("-", "−")}°`), splits: () => [-90, -60, -30, 0, 30, 60, 90], size: 34 },
                    { ...axis, values: (_, ticks) => ticks.map((tick) => (tick === null ? "" : short(tick))), size: 62 },
                ],
                series,
                hooks: { draw: [(plot) => this.marks(plot)], setCursor: [(plot) => this.say(plot)] },
            },
            this.data(),
            this.body,
        );
        this.follow(this.plot.over, (event) => {
            const box = this.plot?.over.getBoundingClientRect();
            return box && this.plot ? this.plot.posToVal(event.clientX - box.left, "x") * DEGREE : undefined;
        });
    }

    /** Draws lines at the light and at the mirror direction. */
    private marks(plot: uPlot): void {
        const { sigma, scatter } = this.state.view;
        const { ctx, bbox } = plot;
        const line = (angle: number, text: string, name: string) => {
            const x = plot.valToPos(angle / DEGREE, "x", true);
            ctx.save();
            ctx.strokeStyle = colour(name);
            // The colour of the lamp is too pale for small text.
            ctx.fillStyle = colour("ink");
            ctx.lineWidth = devicePixelRatio;
            ctx.setLineDash([5 * devicePixelRatio, 4 * devicePixelRatio]);
            ctx.beginPath();
            ctx.moveTo(x, bbox.top);
            ctx.lineTo(x, bbox.top + bbox.height);
            ctx.stroke();
            ctx.font = `${11 * devicePixelRatio}px system-ui, sans-serif`;
            const isLate = x > bbox.left + 0.8 * bbox.width;
            ctx.textAlign = isLate ? "right" : "left";
            ctx.fillText(text, x + (isLate ? -5 : 5) * devicePixelRatio, bbox.top + 13 * devicePixelRatio);
            ctx.restore();
        };
        if (scatter === "reflection" && sigma > 2 * DEGREE) line(-sigma, "light", "lamp");
        line(sigma, scatter === "reflection" ? "mirror" : "straight through", "quiet");
    }

    /** Shows the values under the pointer, or the peaks if the pointer is elsewhere. */
    private say(plot: uPlot): void {
        const at = plot.cursor.idx;
        if (at === null || at === undefined || at < 0) {
            this.readout.textContent = this.peak();
            return;
        }
        const theta = (plot.data[0] as number[])[at];
        const words = this.curves.map(({ material }, index) => {
            const [f, measured] = [1, 2].map((k) => (plot.data[3 * index + k] as (number | null)[])[at]);
            const name = this.curves.length > 1 ? `${material.facts.name} ` : "";
            return `${name}${f === null ? "–" : short(f)} 1/sr${measured === null && f !== null ? " (continued)" : ""}`;
        });
        this.readout.textContent = `θ ${degrees(theta * DEGREE)}: ${words.join(", ")}`;
    }

    private peak(): string {
        const words = this.curves.map(({ curve }, index) => {
            let best = 0;
            curve.f.forEach((f, at) => (best = f > curve.f[best] ? at : best));
            const name = this.curves.length > 1 ? `${["A", "B"][index]}: ` : "";
            return `${name}peak ${short(curve.f[best])} 1/sr at ${degrees(curve.theta[best])}`;
        });
        return words.join(", ");
    }

    /** Moves the light with the pointer while a button is pressed. */
    private follow(target: HTMLElement, angle: (event: PointerEvent) => number | undefined): void {
        target.style.touchAction = "none";
        const move = (event: PointerEvent) => {
            const found = angle(event);
            if (found !== undefined) this.state.set({ sigma: Math.min(Math.abs(found), LOWEST) }, "light");
        };
        target.addEventListener("pointerdown", (event) => {
            target.setPointerCapture(event.pointerId);
            move(event);
        });
        target.addEventListener("pointermove", (event) => {
            if (event.buttons & 1) move(event);
        });
    }

    private room(): { width: number; height: number } {
        const width = Math.max(220, this.body.clientWidth);
        return { width, height: Math.round(Math.min(380, Math.max(240, 0.56 * width))) };
    }

    private resize(): void {
        if (this.state.view.chart === "polar") this.drawPolar();
        else if (this.plot && this.body.clientWidth > 0) this.plot.setSize(this.room());
    }

    private polarFrame(): { x: number; y: number; radius: number } {
        const { width, height } = this.canvas;
        const scale = width / Math.max(1, this.canvas.clientWidth);
        const radius = Math.min(width / 2 - 34 * scale, height - 44 * scale);
        return { x: width / 2, y: height - 22 * scale, radius };
    }

    private polarAngle(event: PointerEvent): number {
        const box = this.canvas.getBoundingClientRect();
        const { x, y } = this.polarFrame();
        const scale = this.canvas.width / box.width;
        return Math.atan2((event.clientX - box.left) * scale - x, y - (event.clientY - box.top) * scale);
    }

    private drawPolar(): void {
        if (this.canvas.clientWidth < 120 || this.curves.length === 0) return;
        fit(this.canvas);
        const context = this.canvas.getContext("2d");
        if (!context) return;
        const { x, y, radius } = this.polarFrame();
        const scale = this.canvas.width / Math.max(1, this.canvas.clientWidth);
        context.clearRect(0, 0, this.canvas.width, this.canvas.height);
        const values = this.curves.flatMap(({ curve }) => Array.from(curve.f)).filter((f) => f > 0);
        const most = values.reduce((a, b) => Math.max(a, b), 1e-30);
        const isLog = this.state.view.scale === "log";
        const [low, high] = isLog ? decades(Math.max(values.reduce((a, b) => Math.min(a, b), most), most * 1e-4), most) : [0, most * 1.04];
        const place = (f: number) => (isLog ? Math.max(0, Math.log(f / low) / Math.log(high / low)) : Math.max(0, f / high));
        const point = (theta: number, share: number): [number, number] => [x + radius * share * Math.sin(theta), y - radius * share * Math.cos(theta)];
        context.font = `${11 * scale}px system-ui, sans-serif`;
        context.lineWidth = scale;
        context.strokeStyle = colour("line");
        context.fillStyle = colour("quiet");
        context.textAlign = "center";
        const rings = isLog ? ringsOf(low, high) : [0.25, 0.5, 0.75, 1].map((share) => share * high);
        for (const ring of rings) {
            const share = place(ring);
            if (share <= 0.02) continue;
            context.beginPath();
            context.arc(x, y, radius * share, Math.PI, 2 * Math.PI);
            context.stroke();
            context.fillText(short(ring), x + radius * share, y + 14 * scale);
        }
        for (let angle = -90; angle <= 90; angle += 30) {
            context.beginPath();
            context.moveTo(x, y);
            context.lineTo(...point(angle * DEGREE, 1));
            context.stroke();
            const [px, py] = point(angle * DEGREE, 1 + (16 * scale) / radius);
            if (Math.abs(angle) < 90) context.fillText(`${String(angle).replace("-", "−")}°`, px, py + 4 * scale);
        }
        for (const [at, { curve }] of this.curves.entries()) {
            context.strokeStyle = colour(at === 0 ? "a" : "b");
            context.fillStyle = context.strokeStyle;
            context.lineWidth = 2 * scale;
            context.beginPath();
            curve.f.forEach((f, k) => context.lineTo(...point(curve.theta[k], f > 0 ? Math.min(place(f), 1) : 0)));
            context.stroke();
            context.globalAlpha = 0.1;
            context.lineTo(x, y);
            context.fill();
            context.globalAlpha = 1;
        }
        const { sigma } = this.state.view;
        context.strokeStyle = context.fillStyle = colour("lamp");
        context.lineWidth = 2 * scale;
        context.beginPath();
        context.moveTo(...point(-sigma, 1));
        context.lineTo(x, y);
        context.stroke();
        context.beginPath();
        context.arc(...point(-sigma, 1), 6 * scale, 0, 2 * Math.PI);
        context.fill();
        this.readout.textContent = `${this.peak()}; rings in 1/sr`;
    }
}

/** The smallest range of whole decades around positive values, six at most. */
function decades(low: number | null, high: number | null): [number, number] {
    const top = high && high > 0 ? high : 1;
    const bottom = Math.max(low && low > 0 ? low : top / 10, top * 1e-6);
    const end = 10 ** Math.ceil(Math.log10(top) - 1e-9);
    return [Math.min(10 ** Math.floor(Math.log10(bottom) + 1e-9), end / 10), end];
}

function ringsOf(low: number, high: number): number[] {
    const rings = [];
    for (let ring = low * 10; ring <= high * 1.0001; ring *= 10) rings.push(ring);
    return rings;
}
