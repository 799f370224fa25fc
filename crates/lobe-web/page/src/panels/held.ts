// What a file holds that is no material: mirrors, or sides with different channels.
import { degrees, h, short } from "../dom";
import type { FileFacts } from "../state";
import { fill, said } from "./facts";

interface MirrorTable {
    name: string;
    psi: number | null;
    channels: string[];
    rows: { sigma: number; values: number[] }[];
}

export interface Held extends Pick<FileFacts, "name" | "format" | "bytes" | "parts" | "source" | "notes" | "doubts"> {
    mirrors: MirrorTable[];
}

/** The error of a file that can be read, but has no values for pairs of directions. */
export class NoMaterial extends Error {
    constructor(why: string, readonly held: Held) {
        super(why);
    }
}

function table({ name, psi, channels, rows }: MirrorTable): HTMLElement {
    const row = ({ sigma, values }: MirrorTable["rows"][number]) => h("tr", {}, h("th", { scope: "row" }, degrees(sigma)), ...values.map((value) => h("td", {}, short(value))));
    const head = h("tr", {}, ...["σ", ...channels].map((text) => h("th", { scope: "col" }, text)));
    const title = h("h3", {}, psi === null ? `${name} by polar angle of the light` : `${name} by polar angle of the light at ψ ${degrees(psi)}`);
    return h("div", { class: "scroll", tabindex: 0 }, title, h("table", { class: "numbers" }, h("thead", {}, head), h("tbody", {}, ...rows.map(row))));
}

/** Shows it in a dialog of its own. */
export function present({ message, held }: NoMaterial): void {
    const box = h("div", { class: "facts" });
    fill(box, ...said(held), ...held.mirrors.map(table));
    const dialog = h("dialog", { class: "held", "aria-labelledby": "held-title" }, h("h2", { id: "held-title" }, held.name), h("p", {}, message), box, h("form", { method: "dialog" }, h("button", { class: "primary" }, "Close")));
    dialog.addEventListener("close", () => dialog.remove());
    document.body.append(dialog);
    dialog.showModal();
}
