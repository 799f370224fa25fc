// The dialog that exports values, figures, pictures and converted files.
import { h, save } from "./dom";
import type { Engine } from "./engine";
import type { PicturePanel } from "./panels/picture";
import type { HemisphereMap } from "./panels/map";
import { DEGREE, link, type State } from "./state";

interface Target {
    word: string;
    name: string;
    extension: string;
    is_exact: boolean;
}

const stem = (name: string) => name.replace(/\.[^.]*$/, "");

/** Converts an SVG to a PNG of twice its size. */
async function rasterised(svg: string): Promise<Blob | null> {
    const url = URL.createObjectURL(new Blob([svg], { type: "image/svg+xml" }));
    try {
        const image = new Image();
        image.src = url;
        await image.decode();
        const canvas = h("canvas", { width: 2 * image.naturalWidth, height: 2 * image.naturalHeight });
        canvas.getContext("2d")?.drawImage(image, 0, 0, canvas.width, canvas.height);
        return await new Promise((resolve) => canvas.toBlob(resolve, "image/png"));
    } finally {
        URL.revokeObjectURL(url);
    }
}

export function exports(engine: Engine, state: State, picture: PicturePanel, map: HemisphereMap, tell: (text: string) => void, onError: (error: Error) => void): HTMLDialogElement & { present: () => void } {
    const formats = h("select", { id: "target", "aria-label": "Format" });
    const dialog = h("dialog", { id: "export", "aria-labelledby": "export-title" });
    const attempt = (work: () => Promise<void>) => () => void work().catch((error: Error) => onError(error));
    const figure = async (kind: string) => {
        const { a, b, view } = state;
        if (!a) return "";
        const materials = b && ["curves", "polar", "slices", "sphere"].includes(kind) ? [a, b] : [a];
        const requests = `[${materials.map((material) => state.request(material)).join(",")}]`;
        return engine.figure(Uint32Array.from(materials, (material) => material.desk), requests, kind, new Float64Array([view.sigma]));
    };
    const name = () => `${stem(state.a?.facts.name ?? "material")}-${(state.view.sigma / DEGREE).toFixed(0)}deg`;
    const svg = (kind: string) => attempt(async () => save(`${name()}-${kind}.svg`, await figure(kind), "image/svg+xml"));
    const png = (kind: string) =>
        attempt(async () => {
            const blob = await rasterised(await figure(kind));
            if (blob) save(`${name()}-${kind}.png`, blob, "image/png");
        });
    const canvas = (kind: string, source: { png(): Promise<Blob | null> }) =>
        attempt(async () => {
            const blob = await source.png();
            if (blob) save(`${name()}-${kind}.png`, blob, "image/png");
        });
    const button = (id: string, text: string, onclick: () => void) => h("button", { type: "button", id, onclick }, text);
    const convert = attempt(async () => {
        const { a, view } = state;
        if (!a) return;
        const written = await engine.convert(a.desk, formats.value, view.channel);
        save(written.name, written.bytes as BlobPart, "application/octet-stream");
        tell(`${written.name}, with the values and nodes of the file${written.note ? `; ${written.note}` : ""}`);
    });
    const figures = h("div", { class: "figures" });
    const row = (kind: string) => h("div", { class: "row" }, h("span", {}, kind), button(`svg-${kind}`, "SVG", svg(kind)), button(`png-${kind}`, "PNG", png(kind)));
    dialog.append(
        h("h2", { id: "export-title" }, "Export"),
        h("h3", {}, "Values"),
        h("div", { class: "row" }, h("span", {}, "curve, all channels"), button("csv", "CSV", attempt(async () => {
            if (state.a) save(`${name()}.csv`, await engine.table(state.a.desk, state.request(), state.view.sigma), "text/csv");
        }))),
        h("h3", {}, "Figures, as drawn by lobe plot"),
        figures,
        h("h3", {}, "Pictures, as shown"),
        h("div", { class: "row" }, h("span", {}, "material"), button("png-picture", "PNG", canvas("picture", picture))),
        h("div", { class: "row" }, h("span", {}, "hemisphere"), button("png-map", "PNG", canvas("hemisphere", map))),
        h("h3", {}, "The file in another format"),
        h("div", { class: "row" }, formats, button("convert", "Save", convert)),
        h("h3", {}, "A link to this view"),
        h("div", { class: "row" }, h("span", {}, "without the files"), button("copy-link", "Copy", attempt(async () => {
            await navigator.clipboard.writeText(`${location.href.split("#")[0]}#${link(state)}`);
            tell("The link was copied. It does not contain the files, which must be opened again.");
        }))),
        h("form", { method: "dialog" }, h("button", { class: "primary" }, "Close")),
    );
    const present = attempt(async () => {
        if (!state.a) return;
        const { wavelengths, is_polarised } = state.a.facts;
        const kinds = ["curves", "polar", "slices", "channels", "sphere"];
        if ((wavelengths?.length ?? 0) > 1) kinds.push("spectra");
        if (is_polarised) kinds.push("mueller", "polarisation");
        figures.replaceChildren(...kinds.map(row));
        dialog.showModal();
        const targets = JSON.parse(await engine.targets(state.a.desk)) as Target[];
        const option = ({ word, name: title, extension, is_exact }: Target) =>
            h("option", { value: word, disabled: !is_exact }, is_exact ? `${title} (.${extension})` : `${title}: needs resampling with lobe convert`);
        formats.replaceChildren(...targets.map(option));
    });
    dialog.addEventListener("click", (event) => {
        if (event.target === dialog) dialog.close();
    });
    return Object.assign(dialog, { present });
}
