// Opens files in the workers, and lists the open materials.
import { h, refill } from "./dom";
import type { Engine } from "./engine";
import type { Group } from "./files";
import { type Held, NoMaterial } from "./panels/held";
import type { FileFacts, Finding, Material, State } from "./state";

export class Library {
    readonly element = h("ul", { class: "materials", "aria-label": "Materials" });
    private readonly opening = new Map<Material, Promise<number>>();

    constructor(
        private readonly desk: Engine,
        private readonly studio: Engine,
        private readonly state: State,
        private readonly changed: (material: Material) => void,
        private readonly onError: (error: Error) => void,
    ) {}

    /**
     * Opens groups of files. A folder is opened as one material if possible, and otherwise file by file. The first material
     * is shown while the others are read, unless another one is wanted.
     */
    async open(groups: Group[], wanted: { a: string; b: string } = { a: "", b: "" }): Promise<void> {
        let first: Material | undefined;
        const found = (material: Material) => {
            // One that was shown and has been read again does not change what is compared with what.
            if (material === this.state.a || material === this.state.b) this.state.show(this.state.a);
            else if (first || wanted.a) this.update();
            else this.state.show(material);
            first ??= material;
        };
        for (const group of groups) await this.read(group, found);
        if (!first || (!wanted.a && !wanted.b)) return;
        const find = (path: string) => this.state.materials.find((material) => material.path === path);
        const b = wanted.b ? find(wanted.b) : undefined;
        if (b) this.state.b = b;
        this.state.show((wanted.a ? find(wanted.a) : undefined) ?? first);
    }

    private async read(group: Group, found: (material: Material) => void): Promise<void> {
        if (group.isFolder) {
            try {
                found(await this.one(group.path, group.files));
            } catch (error) {
                // The files are separate materials; each is opened with its sidecar.
                const groups = group.files.filter(({ path }) => !path.endsWith(".lobe.toml"));
                const failed: Error[] = [];
                for (const { path, bytes } of groups) {
                    try {
                        const sidecar = group.files.filter((file) => file.path === `${path}.lobe.toml`);
                        found(await this.one(path, [{ path, bytes }, ...sidecar]));
                    } catch (inner) {
                        failed.push(inner as Error);
                    }
                }
                if (groups.length === 0) this.onError(error as Error);
                failed.slice(0, 4).forEach((inner) => this.onError(inner));
                if (failed.length > 4) this.onError(new Error(`${failed.length - 4} more files of ${group.path} cannot be read`));
            }
            return;
        }
        try {
            found(await this.one(group.path, group.files));
        } catch (error) {
            this.onError(error as Error);
        }
    }

    private async one(path: string, files: Material["files"]): Promise<Material> {
        const desk = await this.load(this.desk, path, files);
        const facts = JSON.parse(await this.desk.facts(desk)) as FileFacts;
        const { materials } = this.state;
        const at = materials.findIndex((material) => material.path === path);
        const material: Material = { desk, studio: undefined, path, files, facts, findings: undefined };
        if (at >= 0) {
            const old = materials[at];
            materials[at] = material;
            if (this.state.b === old) this.state.b = material;
            if (this.state.a === old) this.state.a = material;
            void this.desk.close(old.desk);
            if (old.studio !== undefined) void this.studio.close(old.studio);
            this.changed(material);
        } else {
            materials.push(material);
        }
        return material;
    }

    private async load(engine: Engine, path: string, files: Material["files"]): Promise<number> {
        for (const file of files) await engine.add(file.path, file.bytes);
        try {
            return await engine.open(path);
        } catch (error) {
            // It may be of use although it is no material.
            const held = await engine.held(path).catch(() => undefined);
            throw held === undefined ? error : new NoMaterial((error as Error).message, JSON.parse(held) as Held);
        } finally {
            for (const file of files) void engine.remove(file.path);
        }
    }

    /** The number of a material in the worker for pictures and checks, which opens it when it is first needed. */
    ready(material: Material): Promise<number> {
        if (material.studio !== undefined) return Promise.resolve(material.studio);
        let opening = this.opening.get(material);
        if (!opening) {
            opening = this.load(this.studio, material.path, material.files).then((number) => {
                material.studio = number;
                return number;
            });
            opening.finally(() => this.opening.delete(material)).catch(() => {});
            this.opening.set(material, opening);
        }
        return opening;
    }

    /** Checks a material, unless it has been checked or is no longer shown. */
    async check(material: Material): Promise<void> {
        if (material.findings) return;
        const number = await this.ready(material);
        if (material.findings || this.state.a !== material) return;
        material.findings = JSON.parse(await this.studio.findings(number, true)) as Finding[];
    }

    /** Opens all materials again after a worker was restarted. */
    async revive(): Promise<void> {
        for (const material of this.state.materials) {
            material.studio = undefined;
            material.desk = await this.load(this.desk, material.path, material.files).catch(() => material.desk);
        }
    }

    close(material: Material): void {
        const { state } = this;
        void this.desk.close(material.desk);
        if (material.studio !== undefined) void this.studio.close(material.studio);
        state.materials = state.materials.filter((other) => other !== material);
        if (state.b === material) state.b = undefined;
        state.show(state.a === material ? state.materials[0] : state.a);
    }

    update(): void {
        const { materials, a, b } = this.state;
        const item = (material: Material) => {
            const isShown = material === a;
            const isCompared = material === b;
            const name = h("button", { type: "button", class: "name", "aria-pressed": String(isShown), title: material.path, onclick: () => this.state.show(material) }, h("span", { class: `dot ${isShown ? "a" : isCompared ? "b" : ""}` }), h("span", {}, h("strong", {}, material.facts.name), h("small", {}, `${material.facts.kind}, ${material.facts.format}`)));
            const compare = h("button", { type: "button", class: "small", "aria-pressed": String(isCompared), title: "Compare with this", disabled: isShown, onclick: () => {
                this.state.b = isCompared ? undefined : material;
                this.state.show(this.state.a);
            } }, "vs");
            const close = h("button", { type: "button", class: "small", title: `Close ${material.facts.name}`, "aria-label": `Close ${material.facts.name}`, onclick: () => this.close(material) }, "×");
            return h("li", {}, name, materials.length > 1 && compare, close);
        };
        refill(this.element, ...materials.map(item));
    }
}
