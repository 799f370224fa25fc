// All outgoing directions as a disk, of two materials side by side. Dragging moves the light.
import { colour, degrees, fit, h, panel, short } from "../dom";
import { type Engine, Latest, type MapPicture } from "../engine";
import { LOWEST, type Material, type State } from "../state";

interface Probe {
    theta: number;
    phi: number;
    value: number;
    channels: number[];
    is_measured: boolean;
}

/** A material on its disk. */
class Disk {
    readonly canvas = h("canvas", { class: "disk", tabindex: 0, role: "img" });
    readonly name = h("figcaption", { class: "keys" });
    readonly element = h("figure", {}, this.canvas, this.name);
    picture: MapPicture | undefined;
    /** The material that the pointer reads; the first one of a map of differences. */
    material: Material | undefined;

    draw(): void {
        const { picture, canvas } = this;
        if (!picture || canvas.clientWidth < 8) return;
        fit(canvas);
        const context = canvas.getContext("2d");
        if (!context) return;
        const { size, rgba, marks } = picture;
        const { width } = canvas;
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
        const scale = width / Math.max(1, canvas.clientWidth);
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
    }
}

export class HemisphereMap {
    readonly element: HTMLElement;
    private readonly disks = [new Disk(), new Disk()];
    private readonly readout = h("output", { class: "readout", id: "map-value" });
    private readonly bar = h("div", { class: "bar", "aria-hidden": "true" });
    private readonly low = h("span");
    private readonly high = h("span");
    private readonly legend = h("div", { class: "legend" }, this.low, this.bar, this.high);
    private readonly select = h("select", { "aria-label": "What the map shows", id: "map-kind" });
    private readonly latest: Latest;
    private readonly probes: Latest;

    constructor(private readonly engine: Engine, private readonly state: State, onError: (error: Error) => void) {
        this.latest = new Latest(onError);
        this.probes = new Latest(onError);
        this.select.addEventListener("change", () => state.set({ map: this.select.value as typeof state.view.map }));
        const hint = h("p", { class: "hint" }, "Equal areas are equal solid angles. The light is on the left; drag to move it. Pale areas were not measured.");
        const disks = h("div", { class: "scenes" }, ...this.disks.map(({ element }) => element));
        this.element = panel("map", "Hemisphere", [this.select], disks, this.legend, this.readout, hint);
        for (const disk of this.disks) this.follow(disk);
    }

    private follow(disk: Disk): void {
        const { canvas } = disk;
        canvas.style.touchAction = "none";
        canvas.addEventListener("pointerdown", (event) => {
            canvas.setPointerCapture(event.pointerId);
            this.look(disk, event, true);
        });
        canvas.addEventListener("pointermove", (event) => this.look(disk, event, (event.buttons & 1) === 1));
        canvas.addEventListener("pointerleave", () => (this.readout.textContent = this.summary()));
        new ResizeObserver(() => disk.draw()).observe(canvas);
    }

    update(): void {
        const { a, b, view } = this.state;
        if (!a) return;
        const kinds: [string, string, boolean][] = [
            ["values", "Values", true],
            ["colours", "Colours", a.facts.has_colour || (b?.facts.has_colour ?? false)],
            ["dolp", "Degree of polarisation", a.facts.is_polarised],
            ["difference", "Difference ΔE", b !== undefined],
        ];
        this.select.replaceChildren(
            ...kinds.filter(([, , is]) => is).map(([value, text]) => h("option", { value, selected: value === view.map }, text)),
        );
        // A difference is one map of both, and a material that is not polarised has none of the polarisation.
        const isBoth = b !== undefined && view.map !== "difference" && (view.map !== "dolp" || b.facts.is_polarised);
        const shown = isBoth ? [a, b] : [a];
        this.disks.forEach((disk, at) => {
            disk.element.hidden = at >= shown.length;
            disk.material = shown[at];
            const what = view.map === "difference" && b ? `Difference between ${a.facts.name} and ${b.facts.name}` : `Values of ${shown[at]?.facts.name ?? ""}`;
            disk.canvas.setAttribute("aria-label", `${what} for all outgoing directions`);
            disk.name.hidden = !isBoth;
            disk.name.replaceChildren(h("span", {}, h("span", { class: `dot ${at === 0 ? "a" : "b"}` }), shown[at]?.facts.name ?? ""));
        });
        const requests = shown.map((material) => this.state.request(material));
        const { sigma, map, exposure } = view;
        this.latest.run(async () => {
            // One per CSS pixel is enough. A lower resolution while the light is dragged would make the map jump.
            const size = Math.min(320, Math.max(120, Math.round(this.disks[0].canvas.clientWidth)));
            let pictures: MapPicture[];
            if (map === "difference" && b) {
                pictures = [await this.engine.difference(a.desk, b.desk, requests[0], sigma, size)];
            } else {
                const of = (material: Material, at: number, range: number[]) =>
                    this.engine.map(material.desk, requests[at], sigma, size, map === "difference" ? "values" : map, exposure, Float64Array.from(range));
                pictures = await Promise.all(shown.map((material, at) => of(material, at, [])));
                const ends = [Math.min(...pictures.map(({ range }) => range[0])), Math.max(...pictures.map(({ range }) => range[1]))];
                // The same colour is the same value in both.
                if (pictures.some(({ range }) => range[0] !== ends[0] || range[1] !== ends[1])) {
                    pictures = await Promise.all(shown.map((material, at) => of(material, at, ends)));
                }
            }
            this.disks.forEach((disk, at) => (disk.picture = pictures[at]));
            this.draw();
        }, () => this.state.a === a && this.state.b === b);
    }

    private summary(): string {
        const [{ picture }] = this.disks;
        if (!picture || this.state.view.map !== "difference") return "";
        const values = picture.values.filter((value) => !Number.isNaN(value));
        const mean = values.reduce((sum, value) => sum + value, 0) / Math.max(1, values.length);
        return `mean ΔE ${short(mean)} over the hemisphere`;
    }

    private draw(): void {
        const [{ picture }] = this.disks;
        if (!picture) return;
        for (const disk of this.disks) disk.draw();
        const { map } = this.state.view;
        this.legend.hidden = map === "colours";
        const [low, high] = picture.range;
        this.low.textContent = short(low);
        this.high.textContent = map === "difference" ? `${short(high)} ΔE` : map === "dolp" ? short(high) : `${short(high)} 1/sr`;
        if (!this.disks.some(({ canvas }) => canvas.matches(":hover"))) this.readout.textContent = this.summary();
    }

    private look(disk: Disk, event: PointerEvent, drags: boolean): void {
        const { material } = disk;
        const box = disk.canvas.getBoundingClientRect();
        const x = (2 * (event.clientX - box.left)) / box.width - 1;
        const y = 1 - (2 * (event.clientY - box.top)) / box.height;
        if (!material) return;
        this.probes.run(async () => {
            const probe = JSON.parse(await this.engine.probe(material.desk, this.state.request(material), this.state.view.sigma, x, y)) as Probe | null;
            if (!probe) {
                this.readout.textContent = this.summary();
                return;
            }
            if (drags) this.state.set({ sigma: Math.min(probe.theta, LOWEST) }, "light");
            const names = material.facts.channels;
            const channels =
                probe.channels.length > 1 && probe.channels.length <= 4
                    ? ` (${probe.channels.map((value, at) => `${names[at]} ${short(value)}`).join(", ")})`
                    : "";
            const name = this.state.b ? `${material.facts.name} ` : "";
            const words = [`θ ${degrees(probe.theta)}, φ ${degrees(probe.phi)}: ${name}${short(probe.value)} 1/sr${channels}`];
            const { picture } = disk;
            const { map } = this.state.view;
            if (picture && (map === "dolp" || map === "difference")) {
                const pixel = (at: number) => Math.min(picture.size - 1, Math.max(0, Math.floor(at * picture.size)));
                const value = picture.values[pixel(0.5 - 0.5 * y) * picture.size + pixel(0.5 + 0.5 * x)];
                words.push(map === "dolp" ? `DoLP ${short(value)}` : `ΔE ${short(value)}`);
            }
            if (!probe.is_measured) words.push("continued, not measured");
            this.readout.textContent = words.join("; ");
        }, () => this.state.materials.includes(material));
    }

    /** The map as a PNG: two materials side by side. */
    png(): Promise<Blob | null> {
        const canvases = this.disks.filter(({ element }) => !element.hidden).map(({ canvas }) => canvas);
        const size = canvases[0].width;
        const whole = h("canvas", { width: size * canvases.length, height: size });
        const context = whole.getContext("2d");
        canvases.forEach((canvas, at) => context?.drawImage(canvas, at * size, 0));
        return new Promise((resolve) => whole.toBlob(resolve, "image/png"));
    }
}
