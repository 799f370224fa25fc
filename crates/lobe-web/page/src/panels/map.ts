// All outgoing directions as a disk. Dragging moves the light.
import { colour, degrees, fit, h, panel, short } from "../dom";
import { type Engine, Latest, type MapPicture } from "../engine";
import { LOWEST, type State } from "../state";

interface Probe {
    theta: number;
    phi: number;
    value: number;
    channels: number[];
    is_measured: boolean;
}

export class HemisphereMap {
    readonly element: HTMLElement;
    private readonly canvas = h("canvas", { class: "disk", tabindex: 0, role: "img", "aria-label": "Values for all outgoing directions" });
    private readonly readout = h("output", { class: "readout", id: "map-value" });
    private readonly bar = h("div", { class: "bar", "aria-hidden": "true" });
    private readonly low = h("span");
    private readonly high = h("span");
    private readonly legend = h("div", { class: "legend" }, this.low, this.bar, this.high);
    private readonly select = h("select", { "aria-label": "What the map shows", id: "map-kind" });
    private picture: MapPicture | undefined;
    private readonly latest: Latest;
    private readonly probes: Latest;

    constructor(private readonly engine: Engine, private readonly state: State, onError: (error: Error) => void) {
        this.latest = new Latest(onError);
        this.probes = new Latest(onError);
        this.select.addEventListener("change", () => state.set({ map: this.select.value as typeof state.view.map }));
        const hint = h("p", { class: "hint" }, "Equal areas are equal solid angles. The light is on the left; drag to move it. Pale areas were not measured.");
        this.element = panel("map", "Hemisphere", [this.select], this.canvas, this.legend, this.readout, hint);
        this.canvas.style.touchAction = "none";
        this.canvas.addEventListener("pointerdown", (event) => {
            this.canvas.setPointerCapture(event.pointerId);
            this.look(event, true);
        });
        this.canvas.addEventListener("pointermove", (event) => this.look(event, (event.buttons & 1) === 1));
        this.canvas.addEventListener("pointerleave", () => (this.readout.textContent = this.summary()));
        new ResizeObserver(() => this.draw()).observe(this.canvas);
    }

    update(): void {
        const { a, b, view } = this.state;
        if (!a) return;
        const kinds: [string, string, boolean][] = [
            ["values", "Values", true],
            ["colours", "Colours", a.facts.has_colour],
            ["dolp", "Degree of polarisation", a.facts.is_polarised],
            ["difference", "Difference ΔE", b !== undefined],
        ];
        this.select.replaceChildren(
            ...kinds.filter(([, , is]) => is).map(([value, text]) => h("option", { value, selected: value === view.map }, text)),
        );
        this.latest.run(async () => {
            // One per CSS pixel is enough. A lower resolution while the light is dragged would make the map jump.
            const size = Math.min(320, Math.max(120, Math.round(this.canvas.clientWidth)));
            const { sigma, map, exposure } = this.state.view;
            const request = this.state.request(a);
            this.picture =
                map === "difference" && b
                    ? await this.engine.difference(a.desk, b.desk, request, sigma, size)
                    : await this.engine.map(a.desk, request, sigma, size, map === "difference" ? "values" : map, exposure);
            this.draw();
        });
    }

    private summary(): string {
        if (!this.picture) return "";
        const { map } = this.state.view;
        if (map === "difference") {
            const values = this.picture.values.filter((value) => !Number.isNaN(value));
            const mean = values.reduce((sum, value) => sum + value, 0) / Math.max(1, values.length);
            return `mean ΔE ${short(mean)} over the hemisphere`;
        }
        return "";
    }

    private draw(): void {
        if (!this.picture || this.canvas.clientWidth < 8) return;
        fit(this.canvas);
        const context = this.canvas.getContext("2d");
        if (!context) return;
        const { size, rgba, range, marks } = this.picture;
        const { width } = this.canvas;
        const source = new OffscreenCanvas(size, size);
        source.getContext("2d")?.putImageData(new ImageData(new Uint8ClampedArray(rgba), size, size), 0, 0);
        context.clearRect(0, 0, width, width);
        context.imageSmoothingQuality = "high";
        context.save();
        context.beginPath();
        context.arc(width / 2, width / 2, width / 2 - 1, 0, 2 * Math.PI);
        context.clip();
        context.drawImage(source, 0, 0, width, width);
        context.restore();
        const scale = width / Math.max(1, this.canvas.clientWidth);
        const place = (x: number, y: number): [number, number] => [(0.5 + 0.5 * x) * width, (0.5 - 0.5 * y) * width];
        const ring = (at: [number, number], fill: string, line: string) => {
            context.beginPath();
            context.arc(...at, 5.5 * scale, 0, 2 * Math.PI);
            context.lineWidth = 2 * scale;
            context.strokeStyle = line;
            context.fillStyle = fill;
            context.fill();
            context.stroke();
        };
        ring(place(marks[2], marks[3]), "transparent", "#fff");
        ring(place(marks[0], marks[1]), colour("lamp"), "#fff");
        const { map } = this.state.view;
        this.legend.hidden = map === "colours";
        const [low, high] = range;
        this.low.textContent = short(low);
        this.high.textContent = map === "difference" ? `${short(high)} ΔE` : map === "dolp" ? short(high) : `${short(high)} 1/sr`;
        if (!this.canvas.matches(":hover")) this.readout.textContent = this.summary();
    }

    private look(event: PointerEvent, drags: boolean): void {
        const { a } = this.state;
        const box = this.canvas.getBoundingClientRect();
        const x = (2 * (event.clientX - box.left)) / box.width - 1;
        const y = 1 - (2 * (event.clientY - box.top)) / box.height;
        if (!a) return;
        this.probes.run(async () => {
            const probe = JSON.parse(await this.engine.probe(a.desk, this.state.request(a), this.state.view.sigma, x, y)) as Probe | null;
            if (!probe) {
                this.readout.textContent = this.summary();
                return;
            }
            if (drags) this.state.set({ sigma: Math.min(probe.theta, LOWEST) }, "light");
            const { facts } = a;
            const names = facts.channels;
            const channels =
                probe.channels.length > 1 && probe.channels.length <= 4
                    ? ` (${probe.channels.map((value, at) => `${names[at]} ${short(value)}`).join(", ")})`
                    : "";
            const words = [`θ ${degrees(probe.theta)}, φ ${degrees(probe.phi)}: ${short(probe.value)} 1/sr${channels}`];
            const { picture } = this;
            const { map } = this.state.view;
            if (picture && (map === "dolp" || map === "difference")) {
                const pixel = (at: number) => Math.min(picture.size - 1, Math.max(0, Math.floor(at * picture.size)));
                const value = picture.values[pixel(0.5 - 0.5 * y) * picture.size + pixel(0.5 + 0.5 * x)];
                words.push(map === "dolp" ? `DoLP ${short(value)}` : `ΔE ${short(value)}`);
            }
            if (!probe.is_measured) words.push("continued, not measured");
            this.readout.textContent = words.join("; ");
        });
    }

    /** The map as a PNG. */
    async png(): Promise<Blob | null> {
        return new Promise((resolve) => this.canvas.toBlob(resolve, "image/png"));
    }
}

