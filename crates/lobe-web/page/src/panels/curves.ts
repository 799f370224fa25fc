// Values in the plane of incidence, Cartesian and polar. Dragging moves the light.
import uPlot from "uplot";

import { choice, colour, degrees, fit, h, panel, short } from "../dom";
import { type Engine, Latest } from "../engine";
import { DEGREE, EACH, isFew, LOWEST, type Material, type State } from "../state";

interface Curve {
    theta: Float64Array;
    f: Float64Array;
    flags: Float64Array;
}

/** A curve that is drawn. */
interface Drawn {
    /** What tells it from the others; empty if there is only one. */
    name: string;
    /** The name of its colour in the style sheet. */
    tone: string;
    curve: Curve;
}

const ROW = 3;
/** All viewing angles, in degrees, and the smallest range that zooming shows. */
const ALL: [number, number] = [-90, 90];
const LEAST = 0.5;
/** The colours of channels that have none of their own. */
const TONES = ["a", "b", "c", "d", "red", "green", "blue", "quiet"];
const OWN: Record<string, string> = { r: "red", red: "red", g: "green", green: "green", b: "blue", blue: "blue" };

function unpacked(rows: Float64Array): Curve {
    const count = rows.length / ROW;
    const column = (at: number) => Float64Array.from({ length: count }, (_, row) => rows[ROW * row + at]);
    return { theta: column(0), f: column(1), flags: column(2) };
}

export class Curves {
    readonly element: HTMLElement;
    /** How long the last curves took, in milliseconds, and how often they were drawn. */
    took = 0;
    updates = 0;
    private readonly body = h("div", { class: "plot", id: "curve-plot" });
    private readonly canvas = h("canvas", { class: "polar", hidden: true, tabindex: 0, "aria-label": "Lobe in polar coordinates" });
    private readonly readout = h("output", { class: "readout", id: "curve-value" });
    private readonly kind;
    private readonly zooms;
    private plot: uPlot | undefined;
    private readonly keys = h("div", { class: "keys", hidden: true });
    private curves: Drawn[] = [];
    private shape = "";
    /** The angles that are shown, in degrees. */
    private range = ALL;
    private readonly latest: Latest;

    constructor(private readonly engine: Engine, private readonly state: State, onError: (error: Error) => void) {
        this.latest = new Latest(onError);
        const kinds = [{ value: "curve", text: "Curve" }, { value: "polar", text: "Polar" }] as const;
        this.kind = choice("Coordinates", kinds, () => state.view.chart, (chart) => state.set({ chart }));
        const zooms = [["−", "Zoom out", 2], ["+", "Zoom in", 0.5]] as const;
        const buttons = zooms.map(([text, title, by]) => h("button", { type: "button", class: "small", title, "aria-label": title, onclick: () => this.zoom(by) }, text));
        this.zooms = h("div", { class: "choice", role: "group", "aria-label": "Zoom" }, ...buttons);
        const hint = h("p", { class: "hint" }, "Drag to move the light, turn the wheel with Ctrl to zoom. Viewing angles are positive away from the light.");
        this.element = panel("curves", "In the plane of incidence", [this.zooms, this.kind], this.body, this.canvas, this.keys, this.readout, hint);
        this.follow(this.canvas, (event) => this.polarAngle(event));
        new ResizeObserver(() => this.resize()).observe(this.body.parentElement ?? this.body);
        matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.redraw(true));
    }

    update(): void {
        this.kind.update();
        const { a, b } = this.state;
        if (!a) return;
        const { sigma, channel } = this.state.view;
        const { channels, name } = a.facts;
        const isEach = channel === EACH && !b && isFew(channels);
        const wanted: [Material, string, string, string][] = isEach
            ? channels.map((name, at) => [a, this.state.request(a, name), name, OWN[name.toLowerCase()] ?? TONES[at % TONES.length]])
            : [[a, this.state.request(a), b ? name : "", "a"]];
        if (b) wanted.push([b, this.state.request(b), b.facts.name, "b"]);
        const isWanted = () => this.state.a === a && this.state.b === b;
        this.latest.run(async () => {
            const begun = performance.now();
            const curve = async (material: Material, request: string, name: string, tone: string): Promise<Drawn> => ({
                name,
                tone,
                curve: unpacked(await this.engine.curve(material.desk, request, sigma)),
            });
            this.curves = await Promise.all(wanted.map((curves) => curve(...curves)));
            this.keys.hidden = this.curves.length < 2;
            this.keys.replaceChildren(...this.curves.map(({ name, tone }) => h("span", {}, h("span", { class: "dot", style: `background: var(--${tone})` }), name)));
            this.redraw();
            this.took = performance.now() - begun;
            this.updates++;
        }, isWanted);
    }

    /** Redraws the curves. The chart is rebuilt if something other than the values has changed, or if `anew`. */
    redraw(anew = false): void {
        const { chart, scale } = this.state.view;
        const isPolar = chart === "polar";
        this.body.hidden = isPolar;
        this.canvas.hidden = !isPolar;
        this.zooms.hidden = isPolar;
        if (this.curves.length === 0) return;
        if (isPolar) {
            this.drawPolar();
            return;
        }
        const shape = `${scale} ${this.curves.map(({ name, tone }) => `${name} ${tone}`).join("|")}`;
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
        for (const { tone } of this.curves) {
            const stroke = colour(tone);
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
                    x: { time: false, range: () => this.range },
                    y: isLog ? { distr: 3, range: (_, low, high) => decades(low, high) } : { range: (_, low, high) => [Math.min(0, low ?? 0), (high || 1) * 1.06] },
                },
                axes: [
                    { ...axis, values: (_, ticks) => ticks.map((tick) => `${String(tick).replace("-", "−")}°`), splits: () => ticks(this.range), size: 34 },
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
        this.plot.over.addEventListener("dblclick", () => this.zoom(Infinity));
        // With Ctrl, as for two fingers on a touchpad: without, the wheel moves the page.
        this.plot.over.addEventListener("wheel", (event) => {
            if (!event.ctrlKey || !this.plot) return;
            event.preventDefault();
            const at = this.plot.posToVal(event.clientX - this.plot.over.getBoundingClientRect().left, "x");
            this.zoom(Math.exp(0.002 * event.deltaY), at);
        }, { passive: false });
    }

    /** Shows so many times as many angles, about one in degrees that stays where it is: the mirror direction, if it is shown. */
    zoom(by: number, at?: number): void {
        const [low, high] = this.range;
        const mirror = this.state.view.sigma / DEGREE;
        const fixed = at ?? (mirror >= low && mirror <= high ? mirror : 0.5 * (low + high));
        const width = Math.min(ALL[1] - ALL[0], Math.max(LEAST, (high - low) * by));
        const start = Number.isFinite(by) ? fixed - ((fixed - low) / (high - low)) * width : ALL[0];
        const first = Math.min(ALL[1] - width, Math.max(ALL[0], start));
        this.range = [first, first + width];
        this.plot?.setData(this.data());
    }

    /** Draws lines at the light and at the mirror direction. */
    private marks(plot: uPlot): void {
        const { sigma, scatter } = this.state.view;
        const { ctx, bbox } = plot;
        const line = (angle: number, text: string, name: string) => {
            if (angle / DEGREE < this.range[0] || angle / DEGREE > this.range[1]) return;
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
        const words = this.curves.map(({ name }, index) => {
            const [f, measured] = [1, 2].map((k) => (plot.data[3 * index + k] as (number | null)[])[at]);
            return `${name && `${name} `}${f === null ? "–" : short(f)} 1/sr${measured === null && f !== null ? " (continued)" : ""}`;
        });
        this.readout.textContent = `θ ${degrees(theta * DEGREE)}: ${words.join(", ")}`;
    }

    private peak(): string {
        const words = this.curves.map(({ name, curve }) => {
            let best = 0;
            curve.f.forEach((f, at) => (best = f > curve.f[best] ? at : best));
            return `${name && `${name}: `}peak ${short(curve.f[best])} 1/sr at ${degrees(curve.theta[best])}`;
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
        for (const { tone, curve } of this.curves) {
            context.strokeStyle = colour(tone);
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

/** Round angles in a range of degrees, eight at most. */
function ticks([low, high]: [number, number]): number[] {
    const step = [0.1, 0.2, 0.5, 1, 2, 5, 10, 15, 30].find((step) => (high - low) / step <= 7) ?? 30;
    const first = Math.ceil(low / step - 1e-9);
    const count = Math.floor(high / step + 1e-9) - first + 1;
    return Array.from({ length: count }, (_, at) => Number(((first + at) * step).toFixed(1)) + 0);
}

function ringsOf(low: number, high: number): number[] {
    const rings = [];
    for (let ring = low * 10; ring <= high * 1.0001; ring *= 10) rings.push(ring);
    return rings;
}
