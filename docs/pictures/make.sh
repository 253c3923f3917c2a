#!/usr/bin/env bash
# Draws docs/pictures/compare.png from runs of plumb, and stress.svg where the folder of a `plumb stress` is named too:
# `docs/pictures/make.sh results/results.jsonl [stress]`.
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
for engine in plumb-precise plumb box2d bullet; do
  ../../plumb run 'pendulum_chain[2]' --engine "$engine" --duration 3 --format csv |
    awk -F, '$2 == "rod1" { print $3 + cos($5) / 2, $4 + sin($5) / 2 }' >"$work/$engine"
done

python3 - "$results" "$work" <<'PY'
import json, sys
results, work = sys.argv[1:]
rows = [json.loads(line) for line in open(results)]
label = lambda r: r["scenario"] + ("/" + r["variant"] if r["variant"] else f"[{r['size']}]")
places = {name: i for i, name in enumerate(dict.fromkeys(label(r) for r in rows))}
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
     work."/box2d" with lines lw 2 dt 2 lc rgb "#d95f02" title "Box2D", \
     work."/plumb" with lines lw 6 lc rgb "#a5dfbf" title "plumb realtime", \
     work."/plumb-precise" with lines lw 1.5 lc rgb "#00468b" title "plumb precise"
set title "Largest position error over the run (m)"
set size noratio; unset xlabel; unset ylabel; set xrange [1e-16:100]; set logscale x; set format x "10^{%L}"
set yrange [*:*] reverse; set key bmargin right horizontal maxcols 3 samplen 1; set grid x
stats work."/places" using 1 nooutput
set yrange [STATS_max + 0.7:-0.7]
set xtics 1e-16, 100
set datafile separator tab
plot work."/places" using (1e-16):1:ytic(2) with points pt 0 notitle, \
     work."/error-plumb-precise" using 2:1 with points pt 7 ps 1.6 lc rgb "#00468b" title "plumb precise", \
     work."/error-plumb" using 2:1 with points pt 5 ps 1.4 lc rgb "#2a9d5c" title "plumb realtime", \
     work."/error-plumb-float" using 2:1 with points pt 4 ps 1.4 lc rgb "#2a9d5c" title "in float", \
     work."/error-box2d" using 2:1 with points pt 9 ps 1.6 lc rgb "#d95f02" title "Box2D", \
     work."/error-bullet" using 2:1 with points pt 2 ps 1.4 lc rgb "#7a3b9d" title "Bullet"
PLOT
