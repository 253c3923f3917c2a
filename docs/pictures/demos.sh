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
picture ragdoll 0.9 '0.1 press -4.2 1.6
0.3 drag -3.6 2
0.5 drag -3 2.6
0.8 drag -2.6 3.2'
picture thousand 2.5 '0 set bodies=1000'
picture sandbox 1.6 '0 set tool=spring
0.1 press 3.5 5.5
0.15 drag 2.5 1
0.2 release 2.5 0.6
0.3 set tool=wall
0.3 press -5 1
0.35 release -3 0.4
0.5 set tool=circle
0.5 press -4.4 2
0.55 release -4.1 2
0.6 set tool=triangle
0.6 press 0 3
0.65 release 1 3.8
1 set tool=box
1.2 press -0.4 4
1.3 drag 1 5' --show velocities --show masses
"$plumb" view 'pendulum_chain[5]' --headless --theme light --width 900 --height 560 --colours 64 --seconds 0.9 \
  --ghost box2d --ghost bullet --screenshot view.png >/dev/null
