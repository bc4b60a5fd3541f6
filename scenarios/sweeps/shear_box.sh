#!/bin/sh
# How the number of cells changes the sheared copper box: mean displacement of the whole box, at most and on average.
#
# Exact (finite elements, static): the box as a whole moves by 3.354e-7 m; under a sudden force it swings about that.
# Usage, from the top of the repository: sh scenarios/sweeps/shear_box.sh [folder for the runs]
set -eu

here=$(CDPATH= cd -- "$(dirname -- "$0")" && pwd)
runs=${1:-runs/shear_box_cells}
cargo build --release --quiet --manifest-path "$here/../../Cargo.toml"
mpm=${CARGO_TARGET_DIR:-$here/../../target}/release/mpm

printf '%-10s  %10s  %16s  %16s\n' 'cell (mm)' particles 'mean move (m)' 'largest move (m)'
for cell in 1 0.5; do
    folder=$runs/$cell
    "$mpm" run "$here/../shear_box.toml" --set "grid.cell_size=\"$cell mm\"" --set 'time.end="126 us"' \
        --output "$folder" --force --quiet --no-pictures
    particles=$(sed -n 's/.*"particles": \([0-9]*\).*/\1/p' "$folder/summary.json")
    awk -F, -v cell="$cell" -v particles="$particles" '
        NR == 2 { start = $2 }
        NR > 1 { move = $2 - start; sum += move; if (move > most) most = move; rows += 1 }
        END { printf "%-10s  %10d  %16.4e  %16.4e\n", cell, particles, sum / rows, most }
    ' "$folder/body_box.csv"
done
