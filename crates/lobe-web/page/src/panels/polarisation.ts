// What becomes of polarised light: the figures of `lobe plot`, with values under the pointer.
import { choice, h, panel } from "../dom";
import { type Engine, Latest } from "../engine";
import type { State } from "../state";

export class Polarisation {
    readonly element: HTMLElement;
    private readonly body = h("div");
    private readonly kind;
    private readonly latest: Latest;

    constructor(private readonly engine: Engine, private readonly state: State, onError: (error: Error) => void) {
        this.latest = new Latest(onError);
        const kinds = [{ value: "polarisation", text: "Degree and angle" }, { value: "mueller", text: "Mueller matrix" }] as const;
        this.kind = choice("Figure", kinds, () => state.view.stokes, (stokes) => state.set({ stokes }));
        this.element = panel("polarisation", "Polarisation", [this.kind], this.body);
    }

    update(): void {
        this.kind.update();
        const { a } = this.state;
        this.element.hidden = !a?.facts.is_polarised;
        if (!a || this.element.hidden) return;
        const { sigma, stokes } = this.state.view;
        const request = { ...JSON.parse(this.state.request(a)), width: Math.round(this.body.clientWidth) };
        this.latest.run(async () => {
            const text = await this.engine.figure(Uint32Array.of(a.desk), JSON.stringify([request]), stokes, Float64Array.of(sigma));
            const figure = new DOMParser().parseFromString(text, "image/svg+xml").documentElement;
            this.body.replaceChildren(document.importNode(figure, true));
        }, () => this.state.a === a);
    }
}
