#!/usr/bin/env bash
# Draws docs/pictures/compare.png from runs of plumb, and stress.svg where the folder of a `plumb stress` is named too:
# `docs/pictures/make.sh results/results.jsonl [stress]`. The results are those of
# `./plumb compare --engine all --no-cost`, with Box2D v3 from npm: `./plumb engines --install box2d3`.
# Needs gnuplot-nox, fonts-dejavu-core and python3. Left: the path of a double pendulum's end, engine by engine, at
# their defaults. Right: the largest position error of each engine in each scenario, from a comparison's results.
set -euo pipefail
results=$(readlink -f -- "${1:?usage: make.sh results.jsonl [STRESS-FOLDER]}")
stress=${2:+$(readlink -f -- "$2")}
cd -- "$(dirname -- "$(readlink -f -- "$0")")"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

if [[ -n $stress ]]; then ../../plumb report "$stress" --out "$work/report.html" --picture stress.svg; fi

# The path of the last rod's free end.
for engine in plumb-precise plumb box2d box2d3 bullet; do
  "${PLUMB:-../../plumb}" run 'pendulum_chain[2]' --engine "$engine" --duration 3 --format csv |
    awk -F, '$2 == "rod1" { print $3 + cos($5) / 2, $4 + sin($5) / 2 }' >"$work/$engine"
done

python3 - "$results" "$work" <<'PY'
import json, sys
results, work = sys.argv[1:]
rows = [json.loads(line) for line in open(results)]
label = lambda r: r["scenario"] + ("/" + r["variant"] if r["variant"] else f"[{r['size']}]")
# Cases by Box2D 2.4's error, those that it skips last.
error_of = {label(r): r["metrics"]["position_error"] for r in rows if r["engine"] == "box2d" and r["status"] == "ok"}
names = sorted(dict.fromkeys(label(r) for r in rows), key=lambda name: error_of.get(name) or (1e9 if name not in error_of else 0))
places = {name: i for i, name in enumerate(names)}
with open(f"{work}/places", "w") as out:
    for name, i in places.items():
        print(i, name.replace("_", " "), sep="\t", file=out)
for engine in {r["engine"] for r in rows}:
    with open(f"{work}/error-{engine}", "w") as out:
        for r in rows:
            if r["engine"] == engine and r["status"] == "ok" and r["metrics"]["position_error"] is not None:
                print(places[label(r)], max(r["metrics"]["position_error"], 1e-16), sep="\t", file=out)
PY

gnuplot -e "work='$work'" - <<'PLOT'
set terminal pngcairo size 1500,640 font "DejaVu Sans,11" background "white"
set output "compare.png"
set multiplot layout 1,2
set title "The end of two hinged rods, let go from the horizontal, over 3 s"
set size ratio -1; set xlabel "x (m)"; set ylabel "y (m)"; set xrange [-2.2:2.2]; set yrange [-2.3:1.3]
set key top left
plot work."/bullet" with lines lw 1.5 dt 3 lc rgb "#7a3b9d" title "Bullet", \
     work."/box2d" with lines lw 2 dt 2 lc rgb "#d95f02" title "Box2D 2.4", \
     work."/plumb" with lines lw 6 lc rgb "#a5dfbf" title "plumb", \
     work."/plumb-precise" with lines lw 1.5 lc rgb "#00468b" title "plumb precise", \
     work."/box2d3" with lines lw 2 dt 4 lc rgb "#b8860b" title "Box2D v3"
set datafile separator tab; set xrange [*:*]; set yrange [*:*]
stats work."/places" using 1 nooutput
set title sprintf("Largest position error over the run (m), %d cases by Box2D 2.4's error", STATS_max + 1)
set size noratio; unset xlabel; unset ylabel; unset ytics; set xrange [1e-16:100]; set logscale x; set format x "10^{%L}"
set key bmargin right horizontal maxcols 3 samplen 1; set grid x
set yrange [STATS_max + 0.7:-0.7]
set xtics 1e-16, 100
plot work."/error-plumb-precise" using 2:1 with points pt 7 ps 0.8 lc rgb "#00468b" title "plumb precise", \
     work."/error-plumb" using 2:1 with points pt 5 ps 0.8 lc rgb "#2a9d5c" title "plumb", \
     work."/error-plumb-float" using 2:1 with points pt 4 ps 0.8 lc rgb "#2a9d5c" title "in float", \
     work."/error-box2d" using 2:1 with points pt 9 ps 0.8 lc rgb "#d95f02" title "Box2D 2.4", \
     work."/error-box2d3" using 2:1 with points pt 8 ps 0.8 lc rgb "#b8860b" title "Box2D v3", \
     work."/error-bullet" using 2:1 with points pt 2 ps 0.8 lc rgb "#7a3b9d" title "Bullet"
PLOT
