# SPDX-License-Identifier: Apache-2.0
"""What the link benchmark prints and writes of its results: table, ratios, CSV, plot."""

import csv
import statistics
import subprocess

from cases import CASES, MEASURES
from common import machine

KINDS = {"module": "modules in a graph", "ours": "ours", "peer": "peers", "bare": "floors"}
PROGRAM_OF = {case.name: case.program for case in CASES}
KEY_OF = {measure.name: measure.key for measure in MEASURES}


def numbers_of(results, case, measure, key=None):
    """The number of each round; nothing where a round gave none."""
    rounds = results.get((case, measure), [])
    if not rounds or any(isinstance(one, str) for one in rounds):
        return []
    return [one[key or KEY_OF[measure]] for one in rounds]


def shown(number):
    if number >= 1e6:
        return "%.2f M" % (number / 1e6)
    if number >= 10_000:
        return "%d,%03d" % (number // 1000, number % 1000)
    return "%.0f" % number if number >= 1000 else "%.3g" % number


def cell(results, case, measure):
    numbers = numbers_of(results, case.name, measure.name)
    if not numbers:
        return "–"
    text = shown(statistics.median(numbers))
    if measure.is_latency:
        late = numbers_of(results, case.name, measure.name, "p99_us")
        text += " (%s)" % shown(statistics.median(late))
    return text


def table(results, cases, measures, is_markdown):
    rounds = len(next(iter(results.values()), []))
    head = "One-way latency: median (p99). %s, medians of %d rounds" % (machine(), rounds)
    print(head + (".\n" if is_markdown else ""))
    widths = [16] + [max(len(measure.title), 15) + 1 for measure in measures]

    def row(cells):
        if is_markdown:
            print("| " + " | ".join(cells) + " |")
        else:
            first, *others = zip(cells, widths)
            print(first[0].ljust(first[1]) + "".join(text.rjust(w) for text, w in others))

    row([""] + [measure.title for measure in measures])
    if is_markdown:
        print("|---|" + "---:|" * len(measures))
    for kind, title in KINDS.items():
        of_kind = [case for case in cases if case.kind == kind]
        if of_kind and not is_markdown:
            print(title)
        for case in of_kind:
            row([case.name] + [cell(results, case, measure) for measure in measures])
    notes = {}
    for case in cases:
        for measure in measures:
            why = [one for one in results[case.name, measure.name] if isinstance(one, str)]
            if why:
                notes.setdefault((case.name, why[0]), []).append(measure.name)
    for (name, why), where in notes.items():
        print("%s– %s, %s: %s" % ("\n" if is_markdown else "", name, ", ".join(where), why))


def best(results, names, measure):
    """The name of the best by its median, or None."""
    found = [
        (statistics.median(numbers_of(results, name, measure)), name)
        for name in names
        if numbers_of(results, name, measure)
    ]
    if not found:
        return None
    return (min if measure.startswith("latency") else max)(found)[1]


def targets(results):
    """Tuples: measure, ours, references, the largest or smallest ratio asked, and the references'
    measure where it is another one."""
    iceoryx = [name for name, program in PROGRAM_OF.items() if program == "iceoryx"]
    peers = [case.name for case in CASES if case.kind == "peer"]
    shm = ["shm_polled", "shm_waiting", "shm"]
    for measure in ("latency_96", "latency_96_one", "latency_image"):
        yield measure, ["module_waiting"], ["shm_waiting"], 1.3
        yield measure, ["module_polled"], ["shm_polled"], 1.3
    yield "latency_96", ["shm_polled"], ["iceoryx_polled"], 1 / 3
    yield "latency_96", ["shm_waiting"], ["iceoryx_waitset"], 1
    yield "latency_96", ["shm_waiting"], ["bare_shm_futex"], 1.25
    yield "latency_96_one", ["shm_waiting"], ["iceoryx_waitset"], 1
    yield "latency_96_one", ["shm_waiting"], ["bare_shm_futex"], 1.25
    yield "latency_image", ["shm_polled"], ["shm_polled"], 1.1, "latency_96"
    yield "messages", shm, peers, 3
    yield "images", shm, iceoryx, 1
    yield "fan_out", shm, iceoryx, 1
    for name, zeromq in (("unix", "zeromq_ipc"), ("tcp", "zeromq_tcp")):
        for measure in ("latency_96", "latency_96_one", "latency_64k", "latency_image"):
            yield measure, [name], ["bare_" + name], 1.15
        yield "messages", [name], [zeromq], 1
        yield "images", [name], ["bare_" + name], 0.9
    yield "latency_96", ["tls"], ["bare_tls"], 1.2
    yield "images", ["tls"], ["bare_tls"], 0.85
    yield "latency_96_one", ["dds"], ["ddsperf_waitset"], 1 / 0.9
    yield "messages", ["dds"], ["ddsperf", "ddsperf_waitset"], 0.9
    yield "images", ["dds"], ["ddsperf", "ddsperf_waitset"], 0.9


def ratios(results, is_markdown):
    """What was asked and what was got; a ratio is the median of the rounds' ratios."""
    lines = []
    for measure, ours, references, asked, *other in targets(results):
        other = other[0] if other else measure
        our, reference = best(results, ours, measure), best(results, references, other)
        if not our or not reference:
            continue
        pairs = zip(numbers_of(results, our, measure), numbers_of(results, reference, other))
        got = statistics.median(a / b for a, b in pairs)
        is_latency = measure.startswith("latency")
        good = got <= asked if is_latency else got >= asked
        asked = "%s %.3g" % ("≤" if is_latency else "≥", asked)
        beside = reference if other == measure else other
        lines.append((measure, our, beside, asked, "%.3g" % got, "yes" if good else "NO"))
    if not lines:
        return
    head = ("measure", "ours", "reference", "asked", "got", "met")
    print()
    if is_markdown:
        print("| " + " | ".join(head) + " |\n|" + "---|" * len(head))
    form = "| %s | %s | %s | %s | %s | %s |" if is_markdown else "%-14s %-12s %-16s %8s %8s  %s"
    for line in lines if is_markdown else [head] + lines:
        print(form % line)


def write_csv(results, path):
    keys = ["median_us", "p99_us", "rounds", "per_second", "received"]
    with open(path, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["case", "measure", "round", *keys, "note"])
        for (case, measure), rounds in results.items():
            for i, one in enumerate(rounds, 1):
                numbers = {} if isinstance(one, str) else one
                values = [numbers.get(key, "") for key in keys]
                note = one if isinstance(one, str) else ""
                writer.writerow([case, measure, i, *values, note])


def plot(results, cases, measures, path):
    """A panel of bars for each measure, one above the other; logarithmic."""
    script = [
        "set terminal svg size 900,%d font 'sans,11' background 'white'" % (260 * len(measures)),
        "set output '%s'" % path,
        "set multiplot layout %d,1" % len(measures),
        "set style fill solid; set boxwidth 0.7; set logscale y; set grid y; unset key",
        "set xtics rotate by -35 noenhanced; set rmargin 16",
    ]
    colors = {"module": "#2e8b57", "ours": "#c0392b", "peer": "#2c6fbb", "bare": "#999999"}
    for measure in measures:
        kind = "latency of " if measure.is_latency else "throughput of "
        lines = []
        for case in cases:
            numbers = numbers_of(results, case.name, measure.name)
            if numbers:
                color = int(colors[case.kind][1:], 16)
                lines.append("%s %g %d" % (case.name, statistics.median(numbers), color))
        if not lines:
            script.append("set multiplot next")
            continue
        script.append("set title '%s%s'" % (kind, measure.title))
        script.append("$data << EOD\n%s\nEOD" % "\n".join(lines))
        script.append(
            "plot [-0.6:%g] $data using 0:2:3:xtic(1) with boxes lc rgb variable"
            % (len(lines) - 0.4)
        )
    done = subprocess.run(["gnuplot"], input="\n".join(script).encode(), capture_output=True)
    if done.returncode != 0:
        print("no plot: " + done.stderr.decode().strip())
