// The lobe as a surface in space, drawn with WebGL2. Dragging turns the view.
import { colour, degrees, fit, h, panel, short } from "../dom";
import { type Engine, Latest } from "../engine";
import type { State } from "../state";

const ROWS = 96;
const COLUMNS = 96;
/** Numbers per vertex: the module returns a position and a value, and a position and a normal are drawn. */
const GIVEN = 4;
const DRAWN = 6;

const VERTEX = `#version 300 es
uniform mat4 matrix;
in vec3 place;
in vec3 normal;
out vec3 n;
out float r;
void main() { gl_Position = matrix * vec4(place, 1.0); n = normal; r = length(place); }`;

const FRAGMENT = `#version 300 es
precision highp float;
uniform vec3 tint;
uniform vec3 eye;
uniform float flat_;
in vec3 n;
in float r;
out vec4 colour;
void main() {
    if (flat_ > 0.0) { colour = vec4(tint * flat_, flat_); return; }
    vec3 m = normalize(n);
    if (dot(m, eye) < 0.0) m = -m;
    float light = 0.42 + 0.5 * max(dot(m, normalize(eye + vec3(0.3, 0.2, 0.9))), 0.0);
    float rim = pow(1.0 - max(dot(m, eye), 0.0), 3.0);
    colour = vec4(mix(tint * light * (0.72 + 0.4 * r), vec3(1.0), 0.25 * rim), 1.0);
}`;

type Vector = [number, number, number];

export class Lobe3D {
    readonly element: HTMLElement;
    private readonly canvas = h("canvas", { class: "space", tabindex: 0, role: "img", "aria-label": "The lobe in space; arrow keys turn it" });
    private readonly gl = this.canvas.getContext("webgl2", { antialias: true, preserveDrawingBuffer: true });
    private program: WebGLProgram | undefined;
    private meshes: { buffer: WebGLBuffer; name: string; file: string; surface: Float32Array }[] = [];
    private matrix = new Float32Array(16);
    private readonly readout = h("output", { class: "readout", id: "space-value" });
    private readonly indices: Uint32Array;
    private indexBuffer: WebGLBuffer | null = null;
    private lines: WebGLBuffer | null = null;
    private turn = -0.35;
    private lift = 0.42;
    private size = 1;
    private readonly latest: Latest;

    constructor(private readonly engine: Engine, private readonly state: State, onError: (error: Error) => void) {
        this.latest = new Latest(onError);
        this.indices = triangles();
        const hint = h("p", { class: "hint" }, this.gl ? "The distance from the origin is the value. Drag to turn the view, turn the wheel with Ctrl or press + and − to zoom; double-click to reset it." : "The surface cannot be drawn, because this browser has no WebGL2.");
        this.element = panel("space", "Lobe in space", [], this.canvas, this.readout, hint);
        if (this.gl) this.prepare(this.gl);
        this.canvas.style.touchAction = "none";
        this.canvas.addEventListener("pointerdown", (event) => this.canvas.setPointerCapture(event.pointerId));
        this.canvas.addEventListener("pointermove", (event) => {
            if (event.buttons & 1) this.rotate(event.movementX * 0.01, event.movementY * 0.01);
            else this.say(event);
        });
        this.canvas.addEventListener("pointerleave", () => (this.readout.textContent = ""));
        // With Ctrl, as for two fingers on a touchpad: without, the wheel moves the page.
        this.canvas.addEventListener("wheel", (event) => {
            if (!event.ctrlKey) return;
            event.preventDefault();
            this.zoom(Math.exp(-0.002 * event.deltaY));
        }, { passive: false });
        this.canvas.addEventListener("dblclick", () => {
            [this.turn, this.lift, this.size] = [-0.35, 0.42, 1];
            this.draw();
        });
        this.canvas.addEventListener("keydown", (event) => {
            const step = 0.12;
            const keys: Record<string, [number, number]> = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -step], ArrowDown: [0, step] };
            const zooms: Record<string, number> = { "+": 1.25, "-": 0.8 };
            const [by, zoom] = [keys[event.key], zooms[event.key]];
            if (!by && !zoom) return;
            event.preventDefault();
            event.stopPropagation();
            if (by) this.rotate(...by);
            else this.zoom(zoom);
        });
        new ResizeObserver(() => this.draw()).observe(this.canvas);
    }

    private rotate(x: number, y: number): void {
        this.turn += x;
        this.lift = Math.min(1.5, Math.max(-0.6, this.lift + y));
        this.draw();
    }

    private zoom(by: number): void {
        this.size = Math.min(40, Math.max(0.5, this.size * by));
        this.draw();
    }

    /** Shows the direction and the value of the point of the surface that is nearest to the pointer. */
    private say(event: PointerEvent): void {
        const box = this.canvas.getBoundingClientRect();
        const [x, y] = [(2 * (event.clientX - box.left)) / box.width - 1, 1 - (2 * (event.clientY - box.top)) / box.height];
        const m = this.matrix;
        // In pixels: points this near to the pointer are under it, and of those the one nearest to the viewer is seen.
        const NEAR = 7;
        let [found, depth] = ["", Infinity];
        for (const { surface, file } of this.meshes) {
            for (let at = 0; at < surface.length; at += GIVEN) {
                const [px, py, pz] = surface.subarray(at, at + 3);
                const across = m[0] * px + m[4] * py + m[8] * pz + m[12] - x;
                const up = m[1] * px + m[5] * py + m[9] * pz + m[13] - y;
                const behind = m[2] * px + m[6] * py + m[10] * pz;
                if (behind >= depth || Math.hypot(across * 0.5 * box.width, up * 0.5 * box.height) > NEAR) continue;
                const radius = Math.hypot(px, py, pz);
                if (radius < 1e-3) continue;
                depth = behind;
                const [theta, phi] = [Math.acos(Math.min(1, Math.abs(pz) / radius)), Math.atan2(py, px)];
                const name = this.meshes.length > 1 ? `${file} ` : "";
                found = `θ ${degrees(theta)}, φ ${degrees(phi < 0 ? phi + 2 * Math.PI : phi)}: ${name}${short(surface[at + 3])} 1/sr`;
            }
        }
        this.readout.textContent = found;
    }

    private prepare(gl: WebGL2RenderingContext): void {
        const program = gl.createProgram();
        for (const [kind, text] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]] as const) {
            const shader = gl.createShader(kind);
            if (!shader) return;
            gl.shaderSource(shader, text);
            gl.compileShader(shader);
            gl.attachShader(program, shader);
        }
        gl.bindAttribLocation(program, 0, "place");
        gl.bindAttribLocation(program, 1, "normal");
        gl.linkProgram(program);
        this.program = program;
        this.indexBuffer = gl.createBuffer();
        gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.indexBuffer);
        gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, this.indices, gl.STATIC_DRAW);
        this.lines = gl.createBuffer();
    }

    update(): void {
        const { a, b } = this.state;
        const { gl } = this;
        if (!a || !gl) return;
        const { sigma } = this.state.view;
        const shown = b ? [a, b] : [a];
        const requests = shown.map((material) => this.state.request(material));
        this.latest.run(async () => {
            const surfaces = await Promise.all(
                shown.map((material, at) => this.engine.surface(material.desk, requests[at], sigma, ROWS, COLUMNS)),
            );
            for (const { buffer } of this.meshes) gl.deleteBuffer(buffer);
            this.meshes = surfaces.map((surface, at) => {
                const buffer = gl.createBuffer();
                gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
                gl.bufferData(gl.ARRAY_BUFFER, withNormals(surface, this.indices), gl.STATIC_DRAW);
                return { buffer, name: at === 0 ? "a" : "b", file: shown[at].facts.name, surface };
            });
            this.draw();
        }, () => this.state.a === a && this.state.b === b);
    }

    draw(): void {
        const { gl, program } = this;
        if (!gl || !program || this.canvas.clientWidth === 0) return;
        fit(this.canvas);
        gl.viewport(0, 0, this.canvas.width, this.canvas.height);
        gl.clearColor(0, 0, 0, 0);
        gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
        gl.enable(gl.DEPTH_TEST);
        gl.useProgram(program);
        const { sigma, psi, scatter, side } = this.state.view;
        // The light is on the left, whatever its azimuth.
        const around = psi + Math.PI / 2 - this.turn;
        const eye: Vector = [Math.cos(around) * Math.cos(this.lift), Math.sin(around) * Math.cos(this.lift), Math.sin(this.lift)];
        const isDown = (side === "back") !== (scatter === "transmission");
        this.matrix = view(eye, this.canvas.width / this.canvas.height, isDown, this.size);
        gl.uniformMatrix4fv(gl.getUniformLocation(program, "matrix"), false, this.matrix);
        gl.uniform3fv(gl.getUniformLocation(program, "eye"), eye);
        const tint = gl.getUniformLocation(program, "tint");
        const flat = gl.getUniformLocation(program, "flat_");
        gl.uniform1f(flat, 0);
        gl.enableVertexAttribArray(0);
        for (const { buffer, name } of this.meshes) {
            gl.uniform3fv(tint, rgb(colour(name)));
            gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
            gl.enableVertexAttribArray(1);
            gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 4 * DRAWN, 0);
            gl.vertexAttribPointer(1, 3, gl.FLOAT, false, 4 * DRAWN, 12);
            gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.indexBuffer);
            gl.drawElements(gl.TRIANGLES, this.indices.length, gl.UNSIGNED_INT, 0);
        }
        gl.disableVertexAttribArray(1);
        gl.enable(gl.BLEND);
        gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
        const up = side === "back" ? -1 : 1;
        const light: Vector = [Math.sin(sigma) * Math.cos(psi), Math.sin(sigma) * Math.sin(psi), up * Math.cos(sigma)];
        const mirror: Vector = [-light[0], -light[1], light[2]];
        const stroke = (points: Vector[], name: string, opacity: number) => {
            gl.bindBuffer(gl.ARRAY_BUFFER, this.lines);
            gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(points.flat()), gl.DYNAMIC_DRAW);
            gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 12, 0);
            gl.uniform3fv(tint, rgb(colour(name)));
            gl.uniform1f(flat, opacity);
            gl.drawArrays(gl.LINE_STRIP, 0, points.length);
        };
        const circle = (radius: number): Vector[] =>
            Array.from({ length: 97 }, (_, k) => [radius * Math.cos((k * Math.PI) / 48), radius * Math.sin((k * Math.PI) / 48), 0]);
        for (const radius of [0.5, 1]) stroke(circle(radius), "quiet", 0.55);
        stroke([[-1, 0, 0], [1, 0, 0]], "quiet", 0.4);
        stroke([[0, -1, 0], [0, 1, 0]], "quiet", 0.4);
        stroke([[0, 0, 0], [0, 0, up]], "quiet", 0.7);
        stroke([[0, 0, 0], scaled(light, 1.15)], "lamp", 1);
        if (scatter === "reflection") stroke([[0, 0, 0], scaled(mirror, 1.1)], "quiet", 0.8);
        gl.disable(gl.BLEND);
    }
}

const scaled = (vector: Vector, by: number): Vector => vector.map((c) => c * by) as Vector;

function triangles(): Uint32Array {
    const indices = new Uint32Array(6 * ROWS * COLUMNS);
    let at = 0;
    for (let row = 0; row < ROWS; row++) {
        for (let column = 0; column < COLUMNS; column++) {
            const corner = row * (COLUMNS + 1) + column;
            const below = corner + COLUMNS + 1;
            indices.set([corner, below, corner + 1, corner + 1, below, below + 1], at);
            at += 6;
        }
    }
    return indices;
}

/** Positions with the sums of the normals of their triangles, for shading. */
function withNormals(surface: Float32Array, indices: Uint32Array): Float32Array {
    const count = surface.length / GIVEN;
    const out = new Float32Array(DRAWN * count);
    for (let at = 0; at < count; at++) out.set(surface.subarray(GIVEN * at, GIVEN * at + 3), DRAWN * at);
    for (let at = 0; at < indices.length; at += 3) {
        const [i, j, k] = indices.subarray(at, at + 3).map((index) => DRAWN * index);
        const [ux, uy, uz] = [0, 1, 2].map((c) => out[j + c] - out[i + c]);
        const [vx, vy, vz] = [0, 1, 2].map((c) => out[k + c] - out[i + c]);
        const normal = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
        for (const corner of [i, j, k]) for (const c of [0, 1, 2]) out[corner + 3 + c] += normal[c];
    }
    // The first and the last azimuth are the same direction, so they share their normals.
    for (let row = 0; row <= ROWS; row++) {
        const [first, last] = [row * (COLUMNS + 1), row * (COLUMNS + 1) + COLUMNS].map((index) => DRAWN * index + 3);
        for (const c of [0, 1, 2]) out[first + c] = out[last + c] = out[first + c] + out[last + c];
    }
    return out;
}

/** The matrix of an orthographic view from `eye`, with z up. */
function view(eye: Vector, aspect: number, isDown: boolean, size: number): Float32Array<ArrayBuffer> {
    const right: Vector = [-eye[1], eye[0], 0];
    const length = Math.hypot(...right) || 1;
    const [rx, ry] = [right[0] / length, right[1] / length];
    const up: Vector = [-eye[2] * ry, eye[2] * rx, eye[0] * ry - eye[1] * rx];
    const zoom = 1.1 * size;
    const [sx, sy] = aspect > 1 ? [zoom / aspect, zoom] : [zoom, zoom * aspect];
    // The origin stays where it is when the lobe is enlarged.
    const shift = (isDown ? 0.3 : -0.38) / size;
    // Column by column.
    return new Float32Array([
        sx * rx, sy * up[0], -0.3 * eye[0], 0,
        sx * ry, sy * up[1], -0.3 * eye[1], 0,
        0, sy * up[2], -0.3 * eye[2], 0,
        0, shift * sy, 0, 1,
    ]);
}

function rgb(hex: string): Vector {
    const number = parseInt(hex.slice(1), 16);
    return [(number >> 16) / 255, ((number >> 8) & 255) / 255, (number & 255) / 255];
}
