"""Converts a material from every format to every other one, and checks the error that is stated for each conversion.

    cargo build --release -p lobe-cli
    python3 xtask/peers/conversions.py target/release/lobe [--markdown TABLE.md]

First a fixture is written in each format; then each of these files is converted to each format. The error that `lobe
convert` states (the root mean square of the difference, relative to that of the values) must be what `lobe compare`
finds, bit for bit, and a file of a format with comments must contain the number. Otherwise the exit code is 1.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

FIXTURE = pathlib.Path(__file__).parents[2] / "fixtures" / "conductor-7x8x13.ddr"

# Name, extension, options, and True if files of the format contain the stated error.
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
    ("UTIA", "bin", [], False),
    ("pBSDF", "pbsdf", [], False),
    ("Mueller tensor", "mueller", [], False),
    ("Mueller CSV", "csv", ["--to", "mueller-csv"], True),
    ("tree", "xml", ["--to", "klems", "--basis", "tree3", "--depth", "5"], True),
]
# If a format does not hold the channels of a source, the first of these that the source has is written.
CHANNELS = [None, "G", "Y", "Visible", "360nm"]


def run(lobe, *arguments):
    return subprocess.run([lobe, *map(str, arguments)], capture_output=True, text=True)


def convert(lobe, source, target, options, channels):
    """The JSON output of a conversion and the channel that was written, or the reason for a refusal and None."""
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
            stated, _ = convert(lobe, FIXTURE, file, options, CHANNELS)
            if isinstance(stated, str):
                sys.exit(f"{name}: {stated}")
            sources[name] = file
        for source, file in sources.items():
            row = [source]
            for name, extension, options, keeps in FORMATS:
                target = folder / f"{source}-to-{name}.{extension}"
                stated, channel = convert(lobe, file, target, options, CHANNELS)
                if isinstance(stated, str):
                    print(f"{source} to {name}: {stated}")
                    row.append("refused")
                    continue
                picked = ["--channel", channel] if channel else []
                found = run(lobe, "compare", "--json", "--pixels", "8", file, target, *picked)
                if stated["error"] is None:
                    # The values were kept, so no error is stated.
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
