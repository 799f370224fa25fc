"""Converts a material from every format to every other one, and checks what is stated of each conversion.

    cargo build --release -p lobe-cli
    python3 xtask/peers/conversions.py target/release/lobe [--markdown TABLE.md]

A fixture is written in each format first; then each of these files is converted to each format. What `lobe convert` states
(the root mean square of the difference, relative to that of the values) must be what `lobe compare` finds, to the bit, and a
file that has a place for a comment must have the number in it. The exit code is 1 if not.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

FIXTURE = pathlib.Path(__file__).parents[2] / "fixtures" / "conductor-7x8x13.ddr"

# Name, extension, options, and whether files of the format keep what is stated of them.
FORMATS = [
    ("DDR", "ddr", [], True),
    ("SSDD", "ssdd", [], True),
    ("Zemax", "bsdf", ["--to", "zemax"], True),
    ("CSV", "csv", [], True),
    ("LightTools", "bsdf", ["--to", "lighttools"], True),
    ("Speos", "brdf", [], True),
    ("MDL", "mbsdf", [], True),
    ("ASTM", "txt", ["--to", "astm"], True),
    ("FRED", "txt", ["--to", "fred"], False),
    ("MERL", "binary", [], False),
    ("RGL", "bsdf", ["--to", "rgl", "--zeniths", "16", "--texels", "32"], True),
    ("Klems", "xml", ["--to", "klems", "--basis", "full"], True),
    ("tree", "xml", ["--to", "klems", "--basis", "tree3", "--depth", "5"], True),
]
# Formats of one channel: the one of these that a source has.
SINGLE = {"FRED", "Speos"}
CHANNELS = ["G", "Y", "Visible"]


def run(lobe, *arguments):
    return subprocess.run([lobe, *map(str, arguments)], capture_output=True, text=True)


def convert(lobe, source, target, options, channels):
    """What was stated of a conversion and the channel that was written; a reason if there was none."""
    reasons = []
    for channel in channels:
        picked = ["--channel", channel] if channel else []
        done = run(lobe, "convert", source, target, "--json", *options, *picked)
        if done.returncode == 0:
            return json.loads(done.stdout), channel
        reasons.append(done.stderr.strip().splitlines()[-1])
    return reasons[0], None


def largest(differences):
    return max(entry["difference"]["relative_rms"] for entry in differences)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("lobe", help="the lobe program")
    parser.add_argument("--markdown", type=pathlib.Path, help="a file for the table")
    arguments = parser.parse_args()
    lobe = str(pathlib.Path(arguments.lobe).resolve())
    failed, rows, compared = False, [], 0
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        sources = {}
        for name, extension, options, _ in FORMATS:
            file = folder / f"from-{name}.{extension}"
            channels = CHANNELS if name in SINGLE else [None]
            stated, _ = convert(lobe, FIXTURE, file, options, channels)
            if isinstance(stated, str):
                sys.exit(f"{name}: {stated}")
            sources[name] = file
        for source, file in sources.items():
            row = [source]
            for name, extension, options, keeps in FORMATS:
                target = folder / f"{source}-to-{name}.{extension}"
                channels = [None, *CHANNELS] if name in SINGLE else [None]
                stated, channel = convert(lobe, file, target, options, channels)
                if isinstance(stated, str):
                    print(f"{source} to {name}: {stated}")
                    row.append("refused")
                    continue
                picked = ["--channel", channel] if channel else []
                found = run(lobe, "compare", "--json", "--pixels", "8", file, target, *picked)
                if stated["error"] is None:
                    # Nothing was computed anew.
                    values = json.loads(found.stdout) if found.returncode == 0 else []
                    worst = largest(values) if values else 0.0
                    same = worst < 2e-6
                    row.append("same" if same else f"{worst:.1e} NOT STATED")
                    failed |= not same
                    continue
                compared += 1
                error = largest(stated["error"])
                is_found = found.returncode == 0 and largest(json.loads(found.stdout)) == error
                mantissa, exponent = f"{stated['error'][0]['difference']['max']:.3e}".split("e")
                words = f"{mantissa}e{int(exponent)}".encode()
                is_kept = not keeps or stated["resampled"] is None or words in target.read_bytes()
                failed |= not (is_found and is_kept)
                row.append(f"{100 * error:.2f} %" + ("" if is_found else " NOT FOUND") + ("" if is_kept else " NOT KEPT"))
            rows.append(row)
            print(" | ".join(row), flush=True)
    header = ["from \\ to", *(name for name, *_ in FORMATS)]
    lines = ["| " + " | ".join(row) + " |" for row in [header, ["---"] * len(header), *rows]]
    print("\n".join(lines))
    print(f"{compared} conversions state an error; {'SOME ARE NOT FOUND' if failed else 'all are found, to the bit'}")
    if arguments.markdown:
        arguments.markdown.write_text("\n".join(lines) + "\n")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
