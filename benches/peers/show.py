"""Show what run.py recorded: tables on standard output, and a picture of run time against cells.

    env/bin/python show.py ../../results/peers.json --plot ../../docs/figures/peers.svg
"""

import argparse
import json
import pathlib

# Told apart by marker and dashes, without colour.
LOOKS = {
    "edgeline": ("o", "-", "#000000"), "tamaas": ("s", "--", "#0072b2"), "ContactMechanics": ("^", "-.", "#d55e00"),
    "aspher": ("D", ":", "#009e73"), "slippy": ("x", (0, (6, 2, 1, 2, 1, 2)), "#aa3377"),
}


def entry(run):
    if "failed" in run:
        return run["failed"]
    if run["code"] == "edgeline":
        return f"{run['seconds']:.2g}"
    return f"{run['seconds']:.2g}, {run['difference']:.0e}"


def tables(record):
    """Markdown: a table for each number of threads."""
    for threads in sorted({run["threads"] for run in record["runs"]}):
        header = [f"{threads} thread{'s' if threads > 1 else ''}", *LOOKS, "ratio"]
        print("\n| " + " | ".join(header) + " |\n" + "|---" * len(header) + "|")
        rows = {}
        for run in record["runs"]:
            if run["threads"] == threads:
                rows.setdefault((run["problem"], run["nx"], run["ny"]), {})[run["code"]] = run
        for (name, nx, ny), runs in rows.items():
            line = [f"{name}, {nx} x {ny}"] + [entry(runs[code]) for code in LOOKS]
            print("| " + " | ".join([*line, ratio(runs, record["limit_s"])]) + " |")


def ratio(runs, limit):
    """How many times as long as edgeline the next one takes, at least."""
    own = runs["edgeline"]["seconds"]
    found = [run["seconds"] for code, run in runs.items() if code != "edgeline" and "seconds" in run]
    rounded = lambda ratio: f"{ratio:.2g}" if ratio < 10 else f"{ratio:.0f}"
    return rounded(min(found) / own) if found else f"> {rounded(limit / own)}"


def plot(record, path):
    """A panel for each problem and number of threads; above the limit of time, the codes that exceeded it."""
    import matplotlib

    matplotlib.use("svg")
    matplotlib.rcParams.update({"svg.hashsalt": "peers", "svg.fonttype": "none", "font.size": 9})
    import matplotlib.pyplot as plt

    limit = record["limit_s"]
    threads = sorted({run["threads"] for run in record["runs"]})
    figure, axes = plt.subplots(len(threads), 2, figsize=(8, 0.5 + 2.8 * len(threads)), sharey=True, squeeze=False)
    for row, count in zip(axes, threads):
        for axis, problem in zip(row, ["smooth", "rough"]):
            for place, (code, (marker, dashes, colour)) in enumerate(LOOKS.items()):
                runs = [r for r in record["runs"] if (r["problem"], r["threads"], r["code"]) == (problem, count, code)]
                done = [(r["nx"] * r["ny"], r["seconds"]) for r in runs if "seconds" in r]
                late = [r["nx"] * r["ny"] * 1.08 ** (place - 2) for r in runs if r.get("failed", "").startswith(">")]
                look = {"marker": marker, "color": colour, "markersize": 5, "fillstyle": "full" if place == 0 else "none"}
                axis.loglog(*(zip(*done) if done else ([], [])), linestyle=dashes, label=code, **look)
                axis.loglog(late, [2.8 * limit] * len(late), linestyle="none", **look)
            axis.axhline(limit, color="0.6", linewidth=0.8)
            axis.text(0.02, 1.1 * limit, f"more than {limit:g} s", color="0.3", fontsize=8,
                      transform=axis.get_yaxis_transform())
            axis.set_ylim(top=6 * limit)
            axis.minorticks_off()
            axis.set_title(f"{problem}, {count} thread{'s' if count > 1 else ''}", fontsize=9)
            axis.grid(True, color="0.9")
            axis.set_xlabel("cells")
        row[0].set_ylabel("run time of the contact (s)")
    figure.legend(*axes[0][0].get_legend_handles_labels(), loc="upper center", ncols=len(LOOKS), frameon=False)
    figure.tight_layout(rect=(0, 0, 1, 1 - 0.3 / figure.get_figheight()))
    figure.savefig(path, metadata={"Date": None})


def main():
    parser = argparse.ArgumentParser(description="Show what run.py recorded.")
    parser.add_argument("record", type=pathlib.Path)
    parser.add_argument("--plot", type=pathlib.Path, help="SVG file to write")
    asked = parser.parse_args()
    record = json.loads(asked.record.read_text())
    versions = ", ".join(f"{code} {version}" for code, version in record["versions"].items())
    loads = [run["load_average"] for run in record["runs"]]
    print(f"{record['date']}, {record['processor']}, {record['cores']} cores; {versions}; tolerance {record['tolerance']:g}, "
          f"at most {record['limit_s']:g} s; load average {min(loads):.1f} to {max(loads):.1f}")
    tables(record)
    if asked.plot:
        plot(record, asked.plot)


if __name__ == "__main__":
    main()
