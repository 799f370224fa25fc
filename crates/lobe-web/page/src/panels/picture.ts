// The materials under a lamp that can be dragged, path-traced while they are shown.
import { choice, h, panel } from "../dom";
import { type Engine, Latest } from "../engine";
import type { Material, State } from "../state";

/** Milliseconds of rendering between two updates of the picture. */
const SLICE = 120;
const SAMPLES = 256;
/** Pixels along each side of the picture of one material, and of each of two. */
const SIZES = [512, 384];

/** A material on its canvas. */
class Scene {
    readonly canvas: HTMLCanvasElement;
    /** The material on the stage of this number in the worker. */
    staged: Material | undefined;
    private readonly context: CanvasRenderingContext2D | null;

    constructor(readonly stage: number) {
        this.canvas = h("canvas", { class: "scene", width: SIZES[0], height: SIZES[0], tabindex: 0, role: "img" });
        this.context = this.canvas.getContext("2d");
    }

    put(rgba: Uint8Array, isBall: boolean): void {
        const size = Math.round(Math.sqrt(rgba.length / 4));
        if (!this.context || size === 0) return;
        const source = new OffscreenCanvas(size, size);
        source.getContext("2d")?.putImageData(new ImageData(new Uint8ClampedArray(rgba), size, size), 0, 0);
        const { width } = this.canvas;
        if (isBall) this.context.clearRect(0, 0, width, width);
        this.context.imageSmoothingQuality = "high";
        this.context.drawImage(source, 0, 0, width, width);
    }
}

export class PicturePanel {
    readonly element: HTMLElement;
    /** How long the last preview took, in milliseconds, and how many there were. */
    took = 0;
    previews = 0;
    private readonly scenes = [new Scene(0), new Scene(1)];
    private readonly readout = h("output", { class: "readout", id: "picture-samples" });
    private readonly forms;
    private readonly skies = h("select", { "aria-label": "Sky", id: "sky" });
    private readonly exposure = h("input", { type: "range", min: -4, max: 4, step: 0.5, "aria-label": "Exposure in stops", id: "exposure" });
    private readonly stops = h("output", { for: "exposure" });
    private generation = 0;
    private isDragging = false;
    private readonly latest: Latest;

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
            this.sayStops();
            void this.show();
        });
        const exposure = h("label", { class: "inline" }, "EV", this.exposure, this.stops);
        const hint = h("p", { class: "hint" }, "Drag to move the lamp. The picture is path-traced in this page, and becomes cleaner with time.");
        const canvases = h("div", { class: "scenes" }, ...this.scenes.map(({ canvas }) => canvas));
        this.element = panel("picture", "Picture", [this.forms, this.skies], canvases, h("div", { class: "row" }, this.readout, exposure), hint);
        for (const { canvas } of this.scenes) this.follow(canvas);
    }

    private follow(canvas: HTMLCanvasElement): void {
        canvas.style.touchAction = "none";
        canvas.addEventListener("pointerdown", (event) => {
            canvas.setPointerCapture(event.pointerId);
            this.isDragging = true;
            this.generation++;
            this.drag(event, canvas);
        });
        canvas.addEventListener("pointermove", (event) => {
            if (this.isDragging) this.drag(event, canvas);
        });
        for (const name of ["pointerup", "pointercancel"] as const) {
            canvas.addEventListener(name, () => {
                if (!this.isDragging) return;
                this.isDragging = false;
                this.update();
            });
        }
        canvas.addEventListener("keydown", (event) => this.key(event));
    }

    /** The materials that are shown, each in its scene. */
    private shown(): { scene: Scene; material: Material }[] {
        const { a, b } = this.state;
        return [a, b].flatMap((material, at) => (material ? [{ scene: this.scenes[at], material }] : []));
    }

    /** Moves the lamp so that its reflection in the ball is near the pointer. */
    private drag(event: PointerEvent, canvas: HTMLCanvasElement): void {
        const box = canvas.getBoundingClientRect();
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
        const { a, b } = this.state;
        this.latest.run(async () => {
            const begun = performance.now();
            const { form, lamp, exposure } = this.state.view;
            for (const { scene, material } of this.shown()) {
                if (form === "ball") {
                    const request = this.state.request(material);
                    scene.put(await this.desk.ball(material.desk, request, scene.canvas.width, new Float32Array(lamp), exposure), true);
                } else if (scene.staged === material && (await this.studio.relight(scene.stage, this.request(128, 1)))) {
                    await this.studio.render(scene.stage, SLICE);
                    scene.put(await this.studio.picture(scene.stage, exposure), false);
                }
            }
            this.took = performance.now() - begun;
            this.previews++;
            this.readout.textContent = `preview, ${this.took.toFixed(0)} ms`;
        }, () => this.state.a === a && this.state.b === b);
    }

    private request(size: number, samples: number): string {
        const { form, sky, lamp } = this.state.view;
        return JSON.stringify({ form, sky, toward: lamp, size: [size, size], samples });
    }

    private sayStops(): void {
        const { exposure } = this.state.view;
        this.stops.textContent = `${exposure > 0 ? "+" : ""}${String(exposure).replace("-", "−")}`;
    }

    /** Restarts the picture. */
    update(): void {
        this.forms.update();
        const { view } = this.state;
        this.skies.value = view.sky;
        this.exposure.value = String(view.exposure);
        this.sayStops();
        const generation = ++this.generation;
        const shown = this.shown();
        this.scenes[1].canvas.hidden = shown.length < 2;
        const size = SIZES[Math.max(0, shown.length - 1)];
        for (const { scene, material } of shown) {
            scene.canvas.setAttribute("aria-label", `${material.facts.name} under the lamp; arrow keys move the lamp`);
            // Setting the size empties a canvas.
            if (scene.canvas.width !== size) scene.canvas.width = scene.canvas.height = size;
        }
        void this.trace(shown, generation).catch((error: Error) => {
            if (generation === this.generation) this.onError(error);
        });
    }

    private async trace(shown: { scene: Scene; material: Material }[], generation: number): Promise<void> {
        const isOld = () => generation !== this.generation;
        for (const { scene, material } of shown) {
            if (scene.staged !== material) this.readout.textContent = "preparing";
            const number = await this.ready(material);
            if (isOld()) return;
            const request = this.request(scene.canvas.width, SAMPLES);
            if (scene.staged !== material || !(await this.studio.relight(scene.stage, request))) {
                scene.staged = undefined;
                await this.studio.stage(scene.stage, number, request);
                scene.staged = material;
            }
        }
        for (let isDone = shown.length === 0; !isDone && !isOld(); ) {
            isDone = true;
            let least = Infinity;
            for (const { scene } of shown) {
                least = Math.min(least, await this.studio.render(scene.stage, SLICE));
                if (isOld()) return;
                isDone = (await this.studio.rendered(scene.stage)) && isDone;
            }
            await this.show();
            if (isOld()) return;
            this.readout.textContent = isDone ? `${least} samples per pixel, done` : `${least} of ${SAMPLES} samples per pixel`;
        }
    }

    private async show(): Promise<void> {
        const generation = this.generation;
        for (const { scene, material } of this.shown()) {
            if (scene.staged !== material) continue;
            const rgba = await this.studio.picture(scene.stage, this.state.view.exposure);
            if (generation === this.generation && !this.isDragging) scene.put(rgba, false);
        }
    }

    /** Forgets the stages, because their worker was restarted or a material has changed. */
    forget(): void {
        for (const scene of this.scenes) scene.staged = undefined;
    }

    /** What is shown, as a PNG: two materials side by side. */
    png(): Promise<Blob | null> {
        const canvases = this.shown().map(({ scene }) => scene.canvas);
        const size = canvases[0]?.width ?? 1;
        const whole = h("canvas", { width: size * canvases.length, height: size });
        const context = whole.getContext("2d");
        canvases.forEach((canvas, at) => context?.drawImage(canvas, at * size, 0));
        return new Promise((resolve) => whole.toBlob(resolve, "image/png"));
    }
}
