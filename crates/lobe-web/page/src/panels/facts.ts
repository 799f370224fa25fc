// The contents of the file, and the findings of the checks.
import { h, panel, size } from "../dom";
import type { FileFacts, Finding, State } from "../state";

const ORDER: Finding["status"][] = ["fail", "warn", "note", "pass"];

function rows(pairs: [string, string][]): HTMLElement {
    const list = h("dl", {});
    for (const [name, value] of pairs) {
        const isLong = value.length > 120;
        const detail = isLong ? h("details", {}, h("summary", {}, `${value.slice(0, 60)}…`), value) : value;
        list.append(h("dt", {}, name), h("dd", {}, detail));
    }
    return list;
}

/** The header of a file, and how it was read. */
export function said({ format, bytes, parts, source, notes, doubts }: Pick<FileFacts, "format" | "bytes" | "parts" | "source" | "notes" | "doubts">): (Node | false)[] {
    return [
        rows([["format", format], ["size", size(bytes)]]),
        ...parts.map((part) => (parts.length > 2 ? h("details", {}, h("summary", {}, part.name || part.rows[0]?.[1] || "part"), rows(part.rows)) : h("div", {}, part.name && h("h3", {}, part.name), rows(part.rows)))),
        source.length > 0 && h("details", {}, h("summary", {}, `Header: ${source.length} ${source.length === 1 ? "entry" : "entries"}`), rows(source)),
        ...notes.map((note) => h("p", { class: "note" }, `Read as: ${note}`)),
        ...doubts.map((doubt) => h("p", { class: "warn" }, `Doubtful: ${doubt}`)),
    ];
}

/** Replaces the contents of a box; `false` and empty strings are left out. */
export function fill(box: HTMLElement, ...children: (Node | string | false)[]): void {
    box.replaceChildren(...children.filter((child): child is Node | string => child !== false && child !== ""));
}

export class FactsPanel {
    readonly facts = h("div", { class: "facts" });
    readonly checks = h("div", { class: "checks", "aria-live": "polite" });
    readonly elements: HTMLElement[];

    constructor(private readonly state: State) {
        this.elements = [panel("findings", "Checks", [], this.checks), panel("facts", "The file", [], this.facts)];
    }

    update(): void {
        const { a } = this.state;
        if (!a) return;
        fill(this.facts, ...said(a.facts));
        this.updateFindings();
    }

    updateFindings(): void {
        const findings = this.state.a?.findings;
        if (!findings) {
            this.checks.replaceChildren(h("p", { class: "hint" }, "Checking…"));
            return;
        }
        const sorted = ORDER.flatMap((status) => findings.filter((finding) => finding.status === status));
        const row = ({ status, check, part, text }: Finding) =>
            h("li", {}, h("span", { class: `badge ${status}` }, status), h("p", {}, h("strong", {}, part ? `${check}, ${part}: ` : `${check}: `), text));
        const said = sorted.filter(({ status }) => status !== "pass");
        const passed = sorted.filter(({ status }) => status === "pass");
        fill(
            this.checks,
            said.length === 0 ? h("p", {}, "No problems were found.") : h("ul", { class: "findings" }, ...said.map(row)),
            passed.length > 0 &&
                h("details", {}, h("summary", {}, passed.length === 1 ? "1 check passed" : `${passed.length} checks passed`), h("ul", { class: "findings" }, ...passed.map(row))),
        );
    }
}
