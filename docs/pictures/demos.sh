#!/usr/bin/env bash
# Draws docs/pictures/DEMO.png, a picture of each demo at play, and view.png, without a display: `docs/pictures/demos.sh [PLUMB]`.
set -euo pipefail
cd -- "$(dirname -- "$(readlink -f -- "$0")")"
plumb=${1:-../../build/release/bin/plumb}
script=$(mktemp)
trap 'rm -f "$script"' EXIT

# Name, seconds, the player's script, more options.
picture() {
  printf '%s\n' "$3" >"$script"
  "$plumb" demo "$1" --headless --theme light --width 900 --height 560 --colours 64 --seconds "$2" --script "$script" \
    --screenshot "$1.png" "${@:4}" >/dev/null
}

picture bouncing_ball 2.6 '0 set restitution=0.9'
picture cannonballs 1.75 '0 set balls=both
0.1 press 25 20
0.2 release 25 20
0.7 press 25 12
0.8 release 25 12
1.35 press 25 8
1.4 release 25 8'
picture pool_break 0.95 '0.1 press -0.64 0
0.2 drag 0.9 0.03
0.3 release 0.9 0.03'
picture spinning_boxes 1.6 '0.1 press -2.6 -2.6
0.15 release -2.6 -2.6
0.2 press -3 0
0.25 release -3 0
0.3 press 2.9 0
0.35 release 2.9 0
0.4 press 2 2.5
0.45 release 2 2.5' --show centres
picture ragdoll 0.9 '0.1 press -5.5 1.5
0.3 drag -4 3
0.5 drag -3 4
0.8 drag -2.5 4.5'
picture thousand 2.5 '0 set bodies=1000'
"$plumb" view 'pendulum_chain[5]' --headless --theme light --width 900 --height 560 --colours 64 --seconds 0.9 \
  --ghost box2d --ghost bullet --screenshot view.png >/dev/null
