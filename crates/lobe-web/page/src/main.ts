// Assembles the page.
import "uplot/dist/uPlot.min.css";

import { choice, degrees, h, refill } from "./dom";
import { Engine } from "./engine";
import { exports } from "./export";
import { chosen, dropped, type Group, served } from "./files";
import { help } from "./help";
import { Library } from "./library";
import { Curves } from "./panels/curves";
import { Details } from "./panels/details";
import { FactsPanel } from "./panels/facts";
import { NoMaterial, present } from "./panels/held";
import { Lobe3D } from "./panels/lobe3d";
import { HalfDifference } from "./panels/half";
import { HemisphereMap } from "./panels/map";
import { PicturePanel } from "./panels/picture";
import { Polarisation } from "./panels/polarisation";
import { DEGREE, EACH, isFew, LOWEST, restore, State } from "./state";

const state = new State();
const wanted = restore(state, location.hash);
const [desk, studio] = [new Engine(), new Engine()];

const messages = h("div", { class: "messages", role: "alert" });
function say(text: string, kind: "error" | "word", more?: HTMLElement): void {
    const message = h("div", { class: `message ${kind}` }, h("p", {}, text), more, h("button", { type: "button", "aria-label": "Dismiss", onclick: () => message.remove() }, "×"));
    messages.append(message);
    while (messages.childElementCount > 5) messages.firstElementChild?.remove();
    if (kind === "word") setTimeout(() => message.remove(), 8000);
}
const onError = (error: Error) => {
    const show = () => error instanceof NoMaterial && present(error);
    say(error.message, "error", error instanceof NoMaterial ? h("button", { type: "button", class: "more", onclick: show }, "What it holds") : undefined);
};

const library = new Library(desk, studio, state, () => picture.forget(), onError);
const curves = new Curves(desk, state, onError);
const map = new HemisphereMap(desk, state, onError);
const space = new Lobe3D(desk, state, onError);
const picture = new PicturePanel(desk, studio, state, (material) => library.ready(material), onError);
const details = new Details(desk, studio, state, (material) => library.ready(material), onError);
const half = new HalfDifference(desk, state, onError);
const polarisation = new Polarisation(desk, state, onError);
const facts = new FactsPanel(state);

// The controls for what is shown of the material.
const side = h("select", { "aria-label": "Light from", id: "side" });
const channel = h("select", { "aria-label": "Channel", id: "channel" });
const sigma = h("input", { type: "range", min: 0, max: 88, step: 0.1, id: "sigma", "aria-label": "Polar angle of the light in degrees" });
const sigmaText = h("output", { for: "sigma", id: "sigma-text" });
const psi = h("input", { type: "range", min: 0, max: 360, step: 1, id: "psi", "aria-label": "Azimuth of the light in degrees" });
const psiText = h("output", { for: "psi", id: "psi-text" });
const psiLabel = h("label", { class: "slider" }, h("span", { title: "azimuth of the light" }, "ψ"), psi, psiText);
const knots = h("div", { class: "knots", role: "group", "aria-label": "Measured incidences" });
const scales = [{ value: "log", text: "log" }, { value: "linear", text: "linear" }] as const;
const scale = choice("Scale", scales, () => state.view.scale, (scale) => state.set({ scale }));
sigma.addEventListener("input", () => state.set({ sigma: Number(sigma.value) * DEGREE }, "light"));
psi.addEventListener("input", () => state.set({ psi: Number(psi.value) * DEGREE }, "light"));
channel.addEventListener("change", () => state.set({ channel: channel.value }));
side.addEventListener("change", () => {
    const [light, scatter] = side.value.split(" ");
    state.set({ side: light, scatter });
});

const input = h("input", { type: "file", multiple: true, hidden: true, id: "file-input" });
input.addEventListener("change", () => {
    if (input.files) void chosen(input.files).then((groups) => open(groups));
    input.value = "";
});
const folder = h("input", { type: "file", webkitdirectory: true, hidden: true, id: "folder-input" });
folder.addEventListener("change", () => {
    if (folder.files) void chosen(folder.files).then((groups) => open(groups));
    folder.value = "";
});

let opened = { count: 0, milliseconds: 0 };
async function open(groups: Group[], from = performance.now()): Promise<void> {
    document.body.classList.add("busy");
    try {
        await library.open(groups, wanted);
        [wanted.a, wanted.b] = ["", ""];
        opened = { count: opened.count + 1, milliseconds: performance.now() - from };
    } finally {
        document.body.classList.remove("busy");
    }
}

const dialogs = {
    export: exports(desk, state, picture, map, (text) => say(text, "word"), onError),
    help: h("dialog", {}) as HTMLDialogElement,
};
const theme = h("button", { type: "button", title: "Dark or light", "aria-label": "Dark or light", onclick: () => {
    const isDark = getComputedStyle(document.documentElement).colorScheme === "dark";
    document.documentElement.dataset.theme = isDark ? "light" : "dark";
    localStorage.setItem("theme", isDark ? "light" : "dark");
    redraw();
} }, "◐");
const stored = localStorage.getItem("theme");
if (stored === "dark" || stored === "light") document.documentElement.dataset.theme = stored;

const lost = h("span", { class: "lost", hidden: true }, "lobe view has ended");
const top = h(
    "header",
    { class: "top" },
    h("h1", {}, "lobe", h("span", {}, "explorer")),
    lost,
    h("nav", {},
        h("button", { type: "button", id: "open", onclick: () => input.click() }, "Open"),
        h("button", { type: "button", id: "show-export", disabled: true, onclick: () => dialogs.export.present() }, "Export"),
        h("button", { type: "button", id: "show-help", onclick: () => dialogs.help.showModal() }, "Help"),
        theme),
    input,
    folder,
);
const welcome = h(
    "main",
    { class: "welcome" },
    h("div", { class: "drop" },
        h("h2", {}, "Drop measured materials here"),
        h("p", {}, "BRDFs, BTDFs and BSDFs in any format that lobe reads: MERL, EPFL (RGL), UTIA, Klems matrices and tensor trees, Zemax, LightTools, Speos, ASTM, Integra, goniometer tables and more. Files or folders, one or several."),
        h("div", { class: "row" },
            h("button", { type: "button", class: "primary", onclick: () => input.click() }, "Choose files"),
            h("button", { type: "button", onclick: () => folder.click() }, "Choose a folder")),
        h("p", { class: "hint" }, "Nothing leaves this computer: files are read and everything is computed in this page.")),
);
const bar = h(
    "div",
    { class: "controls", role: "toolbar", "aria-label": "What is shown" },
    h("label", { class: "slider wide" }, h("span", { title: "polar angle of the light" }, "σ"), sigma, sigmaText),
    knots,
    psiLabel,
    side,
    channel,
    scale,
);
const aside = h("aside", {}, library.element, ...facts.elements, details.albedo);
const board = h(
    "div",
    { class: "board" },
    h("div", { class: "stack" }, curves.element, picture.element, half.element, details.spectrum),
    h("div", { class: "stack" }, map.element, space.element, polarisation.element, details.compare),
);
const desktop = h("main", { class: "desk", hidden: true }, bar, h("div", { class: "columns" }, aside, board));
document.querySelector("#app")?.append(top, welcome, desktop, messages, dialogs.export);

function updateBar(): void {
    const { a, view } = state;
    sigma.value = String(view.sigma / DEGREE);
    sigmaText.textContent = degrees(view.sigma);
    psi.value = String((view.psi / DEGREE + 360) % 360);
    psiText.textContent = degrees(view.psi);
    scale.update();
    if (!a) return;
    psiLabel.hidden = a.facts.is_isotropic && (state.b?.facts.is_isotropic ?? true);
    const words = a.facts.sides.flatMap(({ side, scatters }) => scatters.map((scatter) => ({ value: `${side} ${scatter}`, text: a.facts.sides.length > 1 ? `${scatter}, light from the ${side}` : scatter })));
    side.replaceChildren(...words.map(({ value, text }) => h("option", { value, selected: value === `${view.side} ${view.scatter}` }, text)));
    side.hidden = words.length < 2;
    const all = a.facts.quantity.startsWith("channel") ? `default: ${a.facts.quantity}` : a.facts.quantity || "value";
    const each = isFew(a.facts.channels) && h("option", { value: EACH, selected: view.channel === EACH }, "each channel, in curves");
    channel.replaceChildren(...[h("option", { value: "" }, all), each].filter((option) => option !== false), ...a.facts.channels.map((name) => h("option", { value: name, selected: name === view.channel }, name)));
    channel.hidden = a.facts.channels.length < 2;
    const sigmas = a.facts.sides.find(({ side }) => side === view.side)?.sigmas ?? [];
    refill(
        knots,
        ...sigmas.map((at) => h("button", { type: "button", class: "small", title: `Light at ${degrees(at)}`, "aria-pressed": String(Math.abs(at - view.sigma) < 1e-4), onclick: () => state.set({ sigma: Math.min(at, LOWEST) }, "light") }, degrees(at))),
    );
}

function redraw(): void {
    curves.redraw(true);
    map.update();
    space.draw();
    details.light();
}

state.listen((what) => {
    const { a } = state;
    if (what === "lamp") return;
    if (what === "exposure") {
        if (state.view.map === "colours") map.update();
        return;
    }
    updateBar();
    if (what === "materials") {
        welcome.hidden = a !== undefined;
        desktop.hidden = a === undefined;
        document.querySelector<HTMLButtonElement>("#show-export")?.toggleAttribute("disabled", a === undefined);
        document.title = a ? `${a.facts.name} – lobe explorer` : "lobe explorer";
        library.update();
        facts.update();
    }
    if (what !== "picture") {
        curves.update();
        map.update();
        space.update();
        half.update();
        polarisation.update();
    }
    if (what === "light") details.light();
    if (what === "view" || what === "materials") details.update();
    if (what === "picture" || what === "materials") picture.update();
    if (what === "materials" && a && !a.findings) {
        void library.check(a).then(() => facts.updateFindings(), onError);
    }
});

// Files can be dropped anywhere on the page.
for (const name of ["dragenter", "dragover"] as const) {
    window.addEventListener(name, (event) => {
        event.preventDefault();
        document.body.classList.add("over");
    });
}
for (const name of ["dragleave", "drop"] as const) {
    window.addEventListener(name, (event) => {
        event.preventDefault();
        if (name === "drop" || event.relatedTarget === null) document.body.classList.remove("over");
    });
}
window.addEventListener("drop", (event) => {
    const from = performance.now();
    if (event.dataTransfer) void dropped(event.dataTransfer).then((groups) => open(groups, from), onError);
});

window.addEventListener("keydown", (event) => {
    const target = event.target as HTMLElement;
    if (event.ctrlKey || event.metaKey || event.altKey || ["INPUT", "SELECT", "TEXTAREA"].includes(target.tagName) || document.querySelector("dialog[open]")) return;
    const { view, materials, a, b } = state;
    const light = (by: number) => state.set({ sigma: Math.min(LOWEST, Math.max(0, view.sigma + by * DEGREE)) }, "light");
    const turn = (by: number) => state.set({ psi: (view.psi + by * DEGREE + 2 * Math.PI) % (2 * Math.PI) }, "light");
    const keys: Record<string, () => void> = {
        ArrowLeft: () => light(event.shiftKey ? -10 : -1),
        ArrowRight: () => light(event.shiftKey ? 10 : 1),
        ArrowUp: () => turn(5),
        ArrowDown: () => turn(-5),
        l: () => state.set({ scale: view.scale === "log" ? "linear" : "log" }),
        "+": () => curves.zoom(0.5),
        "-": () => curves.zoom(2),
        "0": () => curves.zoom(Infinity),
        p: () => state.set({ chart: view.chart === "curve" ? "polar" : "curve" }),
        c: () => {
            const others = materials.filter((material) => material !== a);
            state.b = others[b ? others.indexOf(b) + 1 : 0];
            state.show(a);
        },
        o: () => input.click(),
        e: () => a && dialogs.export.present(),
        "?": () => dialogs.help.showModal(),
    };
    const material = materials[Number(event.key) - 1];
    const act = keys[event.key] ?? keys[event.key.toLowerCase()] ?? (material ? () => state.show(material) : undefined);
    if (!act || (event.key.startsWith("Arrow") && !a)) return;
    event.preventDefault();
    act();
});

window.addEventListener("hashchange", () => {
    const { a, b } = restore(state, location.hash);
    const find = (path: string) => state.materials.find((material) => material.path === path);
    if (a) state.b = find(b);
    state.show(find(a) ?? state.a);
    picture.update();
});

for (const engine of [desk, studio]) {
    engine.onDeath = (why) => {
        onError(new Error(`${why}; it has been restarted`));
        picture.forget();
        void library.revive().then(() => state.changed("view"));
    };
}

void desk.about().then(({ version, backends }) => {
    dialogs.help = help(version, backends);
    document.body.append(dialogs.help);
    document.documentElement.dataset.ready = "";
}, onError);
if (new URLSearchParams(location.search).has("served")) {
    void served((groups) => open(groups), (isLost) => (lost.hidden = !isLost));
}
updateBar();

// For tests: the state, the workers, and how long things took.
declare global {
    interface Window {
        explorer: { state: State; desk: Engine; studio: Engine; took(): Record<string, number> };
    }
}
window.explorer = { state, desk, studio, took: () => ({ opened: opened.milliseconds, opens: opened.count, curve: curves.took, curves: curves.updates, preview: picture.took, previews: picture.previews }) };
