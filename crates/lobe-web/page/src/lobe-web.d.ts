// The types of the module; wasm-bindgen writes the same declarations next to it.
declare module "lobe-web" {
    export default function init(options?: { module_or_path: string | URL | BufferSource }): Promise<{ memory: WebAssembly.Memory }>;
    export class Picture {
        readonly size: number;
        readonly values: Float32Array;
        readonly rgba: Uint8Array;
        readonly range: Float64Array;
        readonly measured: Uint8Array;
        readonly marks: Float64Array;
        free(): void;
    }
    export class File {
        readonly name: string;
        readonly bytes: Uint8Array;
        readonly note: string;
        free(): void;
    }
    export class Explorer {
        constructor();
        static version(): string;
        static backends(): string;
        add(path: string, bytes: Uint8Array): void;
        remove(path: string): void;
        open(path: string): number;
        close(material: number): void;
        held(path: string): string;
        facts(material: number): string;
        findings(material: number, quickly: boolean): string;
        eval(material: number, wi: Float32Array, wo: Float32Array, backend: string, strict: boolean): Float32Array;
        curve(material: number, request: string, sigma: number): Float64Array;
        spectra(material: number, request: string, sigma: number, thetas: Float64Array): string;
        albedos(material: number, request: string, sigmas: Float64Array): Float64Array;
        table(material: number, request: string, sigma: number): string;
        figure(materials: Uint32Array, requests: string, kind: string, sigmas: Float64Array): string;
        map(material: number, request: string, sigma: number, size: number, what: string, exposure: number, range: Float64Array): Picture;
        half(material: number, request: string, size: number): Picture;
        half_probe(material: number, request: string, x: number, y: number): string;
        probe(material: number, request: string, sigma: number, x: number, y: number): string;
        surface(material: number, request: string, sigma: number, rows: number, columns: number): Float32Array;
        compare(a: number, b: number, request: string): string;
        difference(a: number, b: number, request: string, sigma: number, size: number): Picture;
        targets(material: number): string;
        convert(material: number, word: string, channel: string): File;
        ball(material: number, request: string, size: number, toward: Float32Array, exposure: number): Uint8Array;
        stage(stage: number, material: number, request: string): void;
        relight(stage: number, request: string): boolean;
        render(stage: number, milliseconds: number): number;
        rendered(stage: number): boolean;
        picture(stage: number, exposure: number): Uint8Array;
    }
}
