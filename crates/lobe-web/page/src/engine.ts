// Calls the module in its worker.
import type { Call, Facts, Reply } from "./worker";

export interface MapPicture {
    size: number;
    values: Float32Array;
    rgba: Uint8Array;
    range: Float64Array;
    measured: Uint8Array;
    marks: Float64Array;
}

export interface WrittenFile {
    name: string;
    bytes: Uint8Array;
    note: string;
}

type Waiting = { resolve: (value: never) => void; reject: (error: Error) => void };

export class Engine {
    private worker: Worker;
    private next = 0;
    private waiting = new Map<number, Waiting>();
    /** Called when the module has stopped and a new one, without materials, has taken its place. */
    onDeath: (why: string) => void = () => {};

    constructor() {
        this.worker = this.start();
    }

    private start(): Worker {
        const worker = new Worker(new URL("./worker.ts", import.meta.url), { type: "module" });
        worker.onmessage = ({ data }: MessageEvent<Reply>) => this.settle(data);
        worker.onerror = (event) => this.die(event.message || "the module cannot be loaded");
        return worker;
    }

    private settle({ id, value, error, isDead }: Reply): void {
        const waiting = this.waiting.get(id);
        this.waiting.delete(id);
        if (error === undefined) {
            waiting?.resolve(value as never);
        } else {
            waiting?.reject(new Error(error));
            if (isDead) this.die(error);
        }
    }

    private die(why: string): void {
        this.worker.terminate();
        for (const { reject } of this.waiting.values()) reject(new Error(why));
        this.waiting.clear();
        this.worker = this.start();
        this.onDeath(why);
    }

    private call<T>(method: string, args: unknown[], buffers: Transferable[] = []): Promise<T> {
        const id = this.next++;
        return new Promise<T>((resolve, reject) => {
            this.waiting.set(id, { resolve: resolve as (value: never) => void, reject });
            this.worker.postMessage({ id, method, args } satisfies Call, buffers);
        });
    }

    about = () => this.call<Facts>("about", []);
    add = (path: string, bytes: Uint8Array) => this.call<void>("add", [path, bytes]);
    remove = (path: string) => this.call<void>("remove", [path]);
    held = (path: string) => this.call<string>("held", [path]);
    open = (path: string) => this.call<number>("open", [path]);
    close = (material: number) => this.call<void>("close", [material]);
    facts = (material: number) => this.call<string>("facts", [material]);
    findings = (material: number, quickly: boolean) => this.call<string>("findings", [material, quickly]);
    evaluate = (material: number, wi: Float32Array, wo: Float32Array, backend: string, strict: boolean) =>
        this.call<Float32Array>("eval", [material, wi, wo, backend, strict]);
    curve = (material: number, request: string, sigma: number) => this.call<Float64Array>("curve", [material, request, sigma]);
    spectra = (material: number, request: string, sigma: number, thetas: Float64Array) =>
        this.call<string>("spectra", [material, request, sigma, thetas]);
    albedos = (material: number, request: string, sigmas: Float64Array) =>
        this.call<Float64Array>("albedos", [material, request, sigmas]);
    table = (material: number, request: string, sigma: number) => this.call<string>("table", [material, request, sigma]);
    figure = (materials: Uint32Array, requests: string, kind: string, sigmas: Float64Array) =>
        this.call<string>("figure", [materials, requests, kind, sigmas]);
    /** An empty `range` lets the values choose the ends of the false colours. */
    map = (material: number, request: string, sigma: number, size: number, what: string, exposure: number, range: Float64Array) =>
        this.call<MapPicture>("map", [material, request, sigma, size, what, exposure, range]);
    probe = (material: number, request: string, sigma: number, x: number, y: number) =>
        this.call<string>("probe", [material, request, sigma, x, y]);
    half = (material: number, request: string, size: number) => this.call<MapPicture>("half", [material, request, size]);
    halfProbe = (material: number, request: string, x: number, y: number) => this.call<string>("half_probe", [material, request, x, y]);
    surface = (material: number, request: string, sigma: number, rows: number, columns: number) =>
        this.call<Float32Array>("surface", [material, request, sigma, rows, columns]);
    compare = (a: number, b: number, request: string) => this.call<string>("compare", [a, b, request]);
    difference = (a: number, b: number, request: string, sigma: number, size: number) =>
        this.call<MapPicture>("difference", [a, b, request, sigma, size]);
    targets = (material: number) => this.call<string>("targets", [material]);
    convert = (material: number, word: string, channel: string) => this.call<WrittenFile>("convert", [material, word, channel]);
    ball = (material: number, request: string, size: number, toward: Float32Array, exposure: number) =>
        this.call<Uint8Array>("ball", [material, request, size, toward, exposure]);
    stage = (stage: number, material: number, request: string) => this.call<void>("stage", [stage, material, request]);
    relight = (stage: number, request: string) => this.call<boolean>("relight", [stage, request]);
    render = (stage: number, milliseconds: number) => this.call<number>("render", [stage, milliseconds]);
    rendered = (stage: number) => this.call<boolean>("rendered", [stage]);
    picture = (stage: number, exposure: number) => this.call<Uint8Array>("picture", [stage, exposure]);
}

interface Task {
    run: () => Promise<void>;
    isWanted: () => boolean;
}

/**
 * Runs tasks one at a time. Of the tasks that arrive while one is running, only the latest is run. Requests are made when a
 * task is given, not when it is run: by then, another material with other sides may be shown.
 */
export class Latest {
    private next: Task | undefined;
    private isBusy = false;

    constructor(private readonly onError: (error: Error) => void) {}

    /** A task whose answer is no longer wanted fails silently: its material was closed, for example. */
    run(run: () => Promise<void>, isWanted: () => boolean = () => true): void {
        this.next = { run, isWanted };
        if (!this.isBusy) void this.drain();
    }

    private async drain(): Promise<void> {
        this.isBusy = true;
        while (this.next) {
            const task = this.next;
            this.next = undefined;
            try {
                await task.run();
            } catch (error) {
                if (task.isWanted()) this.onError(error instanceof Error ? error : new Error(String(error)));
            }
        }
        this.isBusy = false;
    }
}
