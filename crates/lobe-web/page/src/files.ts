// Files that are dropped, chosen in a dialog, or served by `lobe view`.

export interface Given {
    path: string;
    bytes: Uint8Array;
}

/** Files to open together: a file with its sidecar, or a folder, whose files are first tried as one material. */
export interface Group {
    path: string;
    isFolder: boolean;
    files: Given[];
}

const read = async (file: File, path: string): Promise<Given> => ({ path, bytes: new Uint8Array(await file.arrayBuffer()) });

function entryFile(entry: FileSystemFileEntry): Promise<File> {
    return new Promise((resolve, reject) => entry.file(resolve, reject));
}

async function entries(folder: FileSystemDirectoryEntry): Promise<FileSystemEntry[]> {
    const reader = folder.createReader();
    const all: FileSystemEntry[] = [];
    // A reader returns some entries at a time, and none at the end.
    for (;;) {
        const some = await new Promise<FileSystemEntry[]>((resolve, reject) => reader.readEntries(resolve, reject));
        if (some.length === 0) return all;
        all.push(...some);
    }
}

async function walk(entry: FileSystemEntry, path: string): Promise<Given[]> {
    if (entry.isFile) return [await read(await entryFile(entry as FileSystemFileEntry), path)];
    const inside = await entries(entry as FileSystemDirectoryEntry);
    const files = await Promise.all(inside.filter(({ name }) => !name.startsWith(".")).map((inner) => walk(inner, `${path}/${inner.name}`)));
    return files.flat();
}

/** The dropped files. Must be called while the event is handled. */
export async function dropped(transfer: DataTransfer): Promise<Group[]> {
    const items = [...transfer.items].filter((item) => item.kind === "file");
    const found = items.map((item) => ({ entry: item.webkitGetAsEntry?.() ?? null, file: item.getAsFile() }));
    const groups = await Promise.all(
        found.map(async ({ entry, file }): Promise<Group | undefined> => {
            if (entry?.isDirectory) return { path: entry.name, isFolder: true, files: await walk(entry, entry.name) };
            return file ? { path: file.name, isFolder: false, files: [await read(file, file.name)] } : undefined;
        }),
    );
    return together(groups.filter((group) => group !== undefined));
}

/** The files, or the folder, chosen in a dialog. */
export async function chosen(list: FileList): Promise<Group[]> {
    const files = [...list];
    const folder = files[0]?.webkitRelativePath.split("/")[0] ?? "";
    if (folder) {
        const inside = await Promise.all(files.map((file) => read(file, file.webkitRelativePath)));
        return [{ path: folder, isFolder: true, files: inside }];
    }
    return together(await Promise.all(files.map(async (file) => ({ path: file.name, isFolder: false, files: [await read(file, file.name)] }))));
}

const SIDECAR = ".lobe.toml";

/** Groups sidecars with the files that they belong to. */
export function together(groups: Group[]): Group[] {
    const sidecars = groups.filter((group) => group.path.endsWith(SIDECAR));
    for (const sidecar of sidecars) {
        groups.find((group) => group.path === sidecar.path.slice(0, -SIDECAR.length))?.files.push(...sidecar.files);
    }
    return groups.filter((group) => !sidecars.includes(group));
}

interface Served {
    path: string;
    url: string;
    isFolder: boolean;
    /** Changes whenever one of the files changes. */
    stamp: string;
    files: { path: string; url: string }[];
}

/** Shows the files that `lobe view` serves, and shows them again when they change. */
export async function served(show: (groups: Group[]) => Promise<void>, lost: (isLost: boolean) => void): Promise<void> {
    const stamps = new Map<string, string>();
    const look = async () => {
        try {
            const list = (await (await fetch("files.json", { cache: "no-store" })).json()) as Served[];
            lost(false);
            const changed = list.filter(({ path, stamp }) => stamps.get(path) !== stamp);
            const groups = await Promise.all(
                changed.map(async ({ path, isFolder, files }) => {
                    const get = async (file: { path: string; url: string }): Promise<Given> => {
                        const answer = await fetch(file.url, { cache: "no-store" });
                        if (!answer.ok) throw new Error(`${file.path}: ${await answer.text()}`);
                        return { path: file.path, bytes: new Uint8Array(await answer.arrayBuffer()) };
                    };
                    return { path, isFolder, files: await Promise.all(files.map(get)) };
                }),
            );
            for (const { path, stamp } of changed) stamps.set(path, stamp);
            if (groups.length > 0) await show(groups);
        } catch {
            lost(true);
        }
        setTimeout(look, 1000);
    };
    await look();
}
