// Values over the half and difference angles, as BRDFs are often looked at.
import { degrees, h, panel, short } from "../dom";
import { type Engine, Latest } from "../engine";
import type { State } from "../state";

interface Probe {
    theta_h: number;
    theta_d: number;
    value: number;
}

const SIZE = 180;

export class HalfDifference {
    readonly element: HTMLElement;
    private readonly canvas = h("canvas", { class: "half", width: SIZE, height: SIZE, role: "img", "aria-label": "Values over the half angle and the difference angle" });
    private readonly low = h("span");
    private readonly high = h("span");
    private readonly readout = h("output", { class: "readout", id: "half-value" });
    private readonly latest: Latest;
    private readonly probes: Latest;
    /** What is shown, so that it is computed only if that has changed. */
    private shown = "";

    constructor(private readonly engine: Engine, private readonly state: State, onError: (error: Error) => void) {
        this.latest = new Latest(onError);
        this.probes = new Latest(onError);
        const legend = h("div", { class: "legend" }, this.low, h("div", { class: "bar", "aria-hidden": "true" }), this.high);
        const axis = (name: string, of: string) => h("div", { class: of }, h("span", {}, "0°"), h("span", {}, name), h("span", {}, "90°"));
        const framed = h("div", { class: "framed" }, axis("difference angle θd", "up"), this.canvas, axis("half angle θh", "along"));
        const hint = h("p", { class: "hint" }, "At φd = 90°. Peaks are columns at the left; the reflection at grazing angles is at the top.");
        this.element = panel("half", "Half and difference angles", [], framed, legend, this.readout, hint);
        this.canvas.addEventListener("pointermove", (event) => this.look(event));
        this.canvas.addEventListener("pointerleave", () => (this.readout.textContent = ""));
    }

    update(): void {
        const { a, view } = this.state;
        this.element.hidden = view.scatter !== "reflection";
        if (!a || this.element.hidden) return;
        const request = this.state.request(a);
        const shown = `${a.desk} ${request}`;
        if (shown === this.shown) return;
        this.latest.run(async () => {
            const { size, rgba, range } = await this.engine.half(a.desk, request, SIZE);
            this.canvas.getContext("2d")?.putImageData(new ImageData(new Uint8ClampedArray(rgba), size, size), 0, 0);
            this.low.textContent = short(range[0]);
            this.high.textContent = `${short(range[1])} 1/sr`;
            this.shown = shown;
        }, () => this.state.a === a);
    }

    private look(event: PointerEvent): void {
        const { a } = this.state;
        const box = this.canvas.getBoundingClientRect();
        const [x, y] = [(event.clientX - box.left) / box.width, 1 - (event.clientY - box.top) / box.height];
        if (!a) return;
        this.probes.run(async () => {
            const probe = JSON.parse(await this.engine.halfProbe(a.desk, this.state.request(a), x, y)) as Probe | null;
            this.readout.textContent = probe ? `θh ${degrees(probe.theta_h)}, θd ${degrees(probe.theta_d)}: ${short(probe.value)} 1/sr` : "";
        }, () => this.state.a === a);
    }
}
