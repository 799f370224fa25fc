// Creating elements, and formatting numbers.

type Child = Node | string | undefined | false;
type Attributes = Record<string, string | number | boolean | undefined | ((event: never) => void)>;

/** Creates an element with children and attributes; a function as `onNAME` listens for the event `NAME`. */
export function h<K extends keyof HTMLElementTagNameMap>(tag: K, attributes: Attributes = {}, ...children: Child[]): HTMLElementTagNameMap[K] {
    const element = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) {
        if (typeof value === "function") element.addEventListener(name.slice(2), value as (event: Event) => void);
        else if (value === true) element.setAttribute(name, "");
        else if (value !== undefined && value !== false) element.setAttribute(name, String(value));
    }
    for (const child of children) if (child) element.append(child);
    return element;
}

/** A group of buttons, one of which is pressed. */
export function choice<T extends string>(
    label: string,
    options: readonly { value: T; text: string; title?: string }[],
    current: () => T,
    choose: (value: T) => void,
): HTMLElement & { update: () => void } {
    const group = h("div", { role: "group", "aria-label": label, class: "choice" });
    const buttons = options.map(({ value, text, title }) => {
        const button = h("button", { type: "button", title, onclick: () => choose(value) }, text);
        group.append(button);
        return { value, button };
    });
    const update = () => {
        for (const { value, button } of buttons) button.setAttribute("aria-pressed", String(value === current()));
    };
    update();
    return Object.assign(group, { update });
}

/** A number with up to four significant digits; in scientific notation, with three, if it is very large or small. */
export function short(value: number): string {
    if (!Number.isFinite(value)) return "–";
    if (value === 0) return "0";
    const magnitude = Math.abs(value);
    const text = magnitude >= 1e-3 && magnitude < 1e5 ? Number(value.toPrecision(4)).toString() : value.toExponential(2);
    return text.replace(/\.?0+e/, "e").replace("e+", "e").replaceAll("-", "−");
}

/** Replaces what is in a box; the focus stays at its place there. */
export function refill(box: Element, ...children: Node[]): void {
    const stops = () => [...box.querySelectorAll<HTMLElement>("button, select, input")];
    const at = stops().indexOf(document.activeElement as HTMLElement);
    box.replaceChildren(...children);
    if (at >= 0) stops()[Math.min(at, stops().length - 1)]?.focus();
}

export function degrees(radians: number): string {
    const rounded = Math.round((radians * 1800) / Math.PI) / 10;
    return `${String(Object.is(rounded, -0) ? 0 : rounded).replace("-", "−")}°`;
}

export function size(bytes: number): string {
    if (bytes < 1e3) return `${bytes} B`;
    return bytes < 1e6 ? `${(bytes / 1e3).toFixed(0)} kB` : `${(bytes / 1e6).toFixed(1)} MB`;
}

/** A colour from the style sheet. */
export function colour(name: string): string {
    return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

/** Saves a file. */
export function save(name: string, content: BlobPart, type: string): void {
    const url = URL.createObjectURL(new Blob([content], { type }));
    const anchor = h("a", { href: url, download: name });
    document.body.append(anchor);
    anchor.click();
    anchor.remove();
    setTimeout(() => URL.revokeObjectURL(url), 10_000);
}

/** Fits a canvas to its box in device pixels; `true` if its size changed. */
export function fit(canvas: HTMLCanvasElement): boolean {
    const scale = Math.min(window.devicePixelRatio || 1, 2);
    const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((n) => Math.max(1, Math.round(n * scale)));
    if (canvas.width === width && canvas.height === height) return false;
    canvas.width = width;
    canvas.height = height;
    return true;
}

/** A panel with a heading, tools next to it, and a body. */
export function panel(id: string, title: string, tools: Child[], ...body: Child[]): HTMLElement {
    return h(
        "section",
        { class: "panel", id, "aria-labelledby": `${id}-title` },
        h("header", {}, h("h2", { id: `${id}-title` }, title), h("div", { class: "tools" }, ...tools)),
        ...body,
    );
}
