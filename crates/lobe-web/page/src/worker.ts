// The worker that holds the module, which does all computations.
import init, { Explorer, File as Written, Picture } from "lobe-web";
import wasm from "lobe-web/wasm?url";

export interface Call {
    id: number;
    method: string;
    args: unknown[];
}

export interface Reply {
    id: number;
    value?: unknown;
    error?: string;
    /** The module has stopped and takes no more calls. */
    isDead?: boolean;
}

export interface Facts {
    version: string;
    backends: string[];
}

let panic = "";
const error = console.error;
console.error = (...words: unknown[]) => {
    panic = words.map(String).join(" ");
    error(...words);
};

const ready = init({ module_or_path: new URL(wasm, self.location.href) }).then(() => new Explorer());

/** Converts a result of the module to plain values, with the buffers to transfer. */
function plain(value: unknown): { value: unknown; buffers: Transferable[] } {
    if (value instanceof Picture) {
        const { size, values, rgba, range, measured, marks } = value;
        value.free();
        return { value: { size, values, rgba, range, measured, marks }, buffers: [values.buffer, rgba.buffer, measured.buffer] };
    }
    if (value instanceof Written) {
        const { name, bytes, note } = value;
        value.free();
        return { value: { name, bytes, note }, buffers: [bytes.buffer] };
    }
    if (ArrayBuffer.isView(value)) {
        return { value, buffers: [value.buffer as ArrayBuffer] };
    }
    return { value, buffers: [] };
}

self.onmessage = async ({ data: { id, method, args } }: MessageEvent<Call>) => {
    let reply: Reply;
    let buffers: Transferable[] = [];
    try {
        const explorer = await ready;
        if (method === "about") {
            reply = { id, value: { version: Explorer.version(), backends: Explorer.backends().split(",") } satisfies Facts };
        } else {
            const call = explorer[method as keyof Explorer] as (...args: unknown[]) => unknown;
            const result = plain(call.apply(explorer, args));
            buffers = result.buffers;
            reply = { id, value: result.value };
        }
    } catch (thrown) {
        const isDead = thrown instanceof WebAssembly.RuntimeError || thrown instanceof RangeError;
        const text = thrown instanceof Error ? thrown.message : String(thrown);
        reply = { id, error: isDead ? `the module has stopped: ${panic || text}` : text, isDead };
    }
    (self as unknown as Worker).postMessage(reply, buffers);
};
