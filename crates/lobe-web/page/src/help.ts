// Units, conventions and keys.
import { h } from "./dom";

const WORDS: [string, string][] = [
    ["f", "The value of the BRDF or BTDF in 1/sr, without the cosine. For a perfect white diffuser it is 1/π = 0.318."],
    ["σ", "The polar angle of the light, from the normal of the lit side."],
    ["ψ", "The azimuth of the light about the normal, counterclockwise from the x axis of the sample."],
    ["θ", "The viewing angle from the normal; in the plane of incidence it is positive away from the light, so that the mirror direction is at θ = σ."],
    ["φ", "The azimuth of the viewer, measured like ψ."],
    ["luminance", "What curves and maps show for colours and spectra: Y of CIE 1931, which is 1/π for a perfect white."],
    ["albedo", "The integral of f cos θ over the hemisphere. More than 1 is impossible for a passive material."],
    ["ΔE", "CIE delta E 2000 between colours relative to a perfect white; about 1 is just noticeable side by side."],
    ["DoLP", "The degree of linear polarisation of the scattered light if the incident light is unpolarised, from 0 to 1."],
    ["continued", "Beyond the measured angles, the value of the nearest measured angle is used; such values are pale in maps and dashed in curves."],
    ["EV", "The exposure of pictures: each stop doubles the brightness."],
];

const KEYS: [string, string][] = [
    ["← →", "move the light by 1° (with Shift 10°)"],
    ["↑ ↓", "turn the sample by 5°"],
    ["L", "linear or logarithmic"],
    ["P", "curve or polar"],
    ["+ −", "zoom in and out of the curve (0 shows all of it)"],
    ["1 – 9", "show that material"],
    ["C", "compare with the next material, or stop comparing"],
    ["O", "open files"],
    ["E", "export"],
    ["?", "this help"],
];

export function help(version: string, backends: string[]): HTMLDialogElement {
    const list = (pairs: [string, string][], tag: "kbd" | "span") => h("dl", {}, ...pairs.flatMap(([name, text]) => [h("dt", {}, h(tag, {}, name)), h("dd", {}, text)]));
    const dialog = h(
        "dialog",
        { id: "help", "aria-labelledby": "help-title" },
        // The focus is here when it opens, so that it begins at its top.
        h("h2", { id: "help-title", tabindex: -1, autofocus: true }, "Units, conventions, keys"),
        h("p", {}, "Directions point away from the surface, with the normal on +z. Everything is computed in this page by lobe's libraries; no file leaves this computer."),
        list(WORDS, "span"),
        h("h3", {}, "Keys"),
        list(KEYS, "kbd"),
        h("p", { class: "hint" }, `lobe ${version}, backends: ${backends.join(", ")}`),
        h("form", { method: "dialog" }, h("button", { class: "primary" }, "Close")),
    );
    dialog.addEventListener("click", (event) => {
        if (event.target === dialog) dialog.close();
    });
    return dialog;
}
