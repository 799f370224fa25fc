// The material under a lamp that can be dragged, path-traced while it is shown.
import { choice, h, panel } from "../dom";
import { type Engine, Latest } from "../engine";
import type { Material, State } from "../state";

/** Milliseconds of rendering between two updates of the picture. */
const SLICE = 120;
const SAMPLES = 256;

export class PicturePanel {
    readonly element: HTMLElement;
    /** How long the last preview took, in milliseconds. */
    took = 0;
    private readonly canvas = h("canvas", { class: "scene", width: 512, height: 512, tabindex: 0, role: "img", "aria-label": "The material under the lamp; arrow keys move the lamp" });
    private readonly readout = h("output", { class: "readout", id: "picture-samples" });
    private readonly forms;
    private readonly skies = h("select", { "aria-label": "Sky", id: "sky" });
    private readonly exposure = h("input", { type: "range", min: -4, max: 4, step: 0.5, "aria-label": "Exposure in stops", id: "exposure" });
    private generation = 0;
    private staged: Material | undefined;
    private isDragging = false;
    private readonly latest: Latest;
    private readonly context = this.canvas.getContext("2d");

    /** `studio` renders the picture, `desk` the preview of a ball. `ready` opens a material in the studio. */
    constructor(
        private readonly desk: Engine,
        private readonly studio: Engine,
        private readonly state: State,
        private readonly ready: (material: Material) => Promise<number>,
        private readonly onError: (error: Error) => void,
    ) {
        this.latest = new Latest(onError);
        const forms = [{ value: "ball", text: "Ball" }, { value: "cloth", text: "Cloth" }, { value: "flat", text: "Flat" }] as const;
        this.forms = choice("Shape", forms, () => state.view.form, (form) => state.set({ form }, "picture"));
        const skies: [string, string][] = [["studio", "Studio"], ["overcast", "Overcast"], ["dusk", "Dusk"], ["dark", "Lamp only"]];
        this.skies.append(...skies.map(([value, text]) => h("option", { value }, text)));
        this.skies.addEventListener("change", () => state.set({ sky: this.skies.value as typeof state.view.sky }, "picture"));
        this.exposure.addEventListener("input", () => {
            state.set({ exposure: Number(this.exposure.value) }, "exposure");
            void this.show();
        });
        const exposure = h("label", { class: "inline" }, "EV", this.exposure);
        const hint = h("p", { class: "hint" }, "Drag to move the lamp. The picture is path-traced in this page, and becomes cleaner with time.");
        this.element = panel("picture", "Picture", [this.forms, this.skies], this.canvas, h("div", { class: "row" }, this.readout, exposure), hint);
        this.canvas.style.touchAction = "none";
        this.canvas.addEventListener("pointerdown", (event) => {
            this.canvas.setPointerCapture(event.pointerId);
            this.isDragging = true;
            this.generation++;
            this.drag(event);
        });
        this.canvas.addEventListener("pointermove", (event) => {
            if (this.isDragging) this.drag(event);
        });
        for (const name of ["pointerup", "pointercancel"] as const) {
            this.canvas.addEventListener(name, () => {
                if (!this.isDragging) return;
                this.isDragging = false;
                this.update();
            });
        }
        this.canvas.addEventListener("keydown", (event) => this.key(event));
    }

    /** Moves the lamp so that its reflection in the ball is near the pointer. */
    private drag(event: PointerEvent): void {
        const box = this.canvas.getBoundingClientRect();
        const x = (2 * (event.clientX - box.left)) / box.width - 1;
        const y = 1 - (2 * (event.clientY - box.top)) / box.height;
        this.aim(x, y);
    }

    private aim(x: number, y: number): void {
        const length = Math.hypot(x, y);
        // From behind the viewer (pointer in the middle) to the side (pointer at the edge), and a little beyond.
        const angle = Math.min(length, 1.15) * 0.5 * Math.PI;
        const [ux, uy] = length > 1e-6 ? [x / length, y / length] : [0, 1];
        this.state.view.lamp = [ux * Math.sin(angle), uy * Math.sin(angle), Math.cos(angle)];
        this.state.changed("lamp");
        this.preview();
    }

    private key(event: KeyboardEvent): void {
        const step = 0.06;
        const keys: Record<string, [number, number]> = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, step], ArrowDown: [0, -step] };
        const by = keys[event.key];
        if (!by) return;
        event.preventDefault();
        event.stopPropagation();
        const [x, y, z] = this.state.view.lamp;
        const angle = Math.atan2(Math.hypot(x, y), z) / (0.5 * Math.PI);
        const flat = Math.hypot(x, y) || 1;
        this.aim((x / flat) * angle + by[0], (y / flat) * angle + by[1]);
        this.update();
    }

    /** Shows a quick picture: a ball lit by the lamp alone, or other shapes path-traced at a low resolution. */
    private preview(): void {
        const { a } = this.state;
        if (!a) return;
        this.latest.run(async () => {
            const begun = performance.now();
            const { form, lamp, exposure } = this.state.view;
            if (form === "ball") {
                const size = this.canvas.width;
                const toward = new Float32Array(lamp);
                const rgba = await this.desk.ball(a.desk, this.state.request(a), size, toward, exposure);
                this.put(rgba, size, true);
            } else if (this.staged === a) {
                const size = 128;
                if (await this.studio.relight(this.stage(size, 1))) {
                    await this.studio.render(SLICE);
                    this.put(await this.studio.picture(exposure), size, false);
                }
            }
            this.took = performance.now() - begun;
            this.readout.textContent = `preview, ${this.took.toFixed(0)} ms`;
        });
    }

    private stage(size: number, samples: number): string {
        const { form, sky, lamp } = this.state.view;
        return JSON.stringify({ form, sky, toward: lamp, size: [size, size], samples });
    }

    /** Restarts the picture. */
    update(): void {
        this.forms.update();
        const { view, a } = this.state;
        this.skies.value = view.sky;
        this.exposure.value = String(view.exposure);
        const generation = ++this.generation;
        if (!a) return;
        void this.trace(a, generation).catch((error: Error) => {
            if (generation === this.generation) this.onError(error);
        });
    }

    private async trace(material: Material, generation: number): Promise<void> {
        const isOld = () => generation !== this.generation;
        if (this.staged !== material) this.readout.textContent = "preparing";
        const number = await this.ready(material);
        if (isOld()) return;
        const request = this.stage(this.canvas.width, SAMPLES);
        if (this.staged !== material || !(await this.studio.relight(request))) {
            this.staged = undefined;
            await this.studio.stage(number, request);
            this.staged = material;
        }
        while (!isOld()) {
            const samples = await this.studio.render(SLICE);
            if (isOld()) return;
            const isDone = await this.studio.rendered();
            await this.show();
            this.readout.textContent = isDone ? `${samples} samples per pixel, done` : `${samples} of ${SAMPLES} samples per pixel`;
            if (isDone) return;
        }
    }

    private async show(): Promise<void> {
        const generation = this.generation;
        if (!this.staged) return;
        const rgba = await this.studio.picture(this.state.view.exposure);
        if (generation === this.generation && !this.isDragging) this.put(rgba, Math.round(Math.sqrt(rgba.length / 4)), false);
    }

    private put(rgba: Uint8Array, size: number, isBall: boolean): void {
        if (!this.context || size === 0) return;
        const source = new OffscreenCanvas(size, size);
        source.getContext("2d")?.putImageData(new ImageData(new Uint8ClampedArray(rgba), size, size), 0, 0);
        if (isBall) this.context.clearRect(0, 0, this.canvas.width, this.canvas.height);
        this.context.imageSmoothingQuality = "high";
        this.context.drawImage(source, 0, 0, this.canvas.width, this.canvas.height);
        this.canvas.classList.toggle("preview", isBall);
    }

    /** Forgets the stage, because its worker was restarted or its material has changed. */
    forget(): void {
        this.staged = undefined;
    }

    png(): Promise<Blob | null> {
        return new Promise((resolve) => this.canvas.toBlob(resolve, "image/png"));
    }
}
