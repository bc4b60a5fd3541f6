#!/bin/sh
# How the time step changes the vibrating bar: the same run at several Courant numbers.
#
# Exact: the centre of mass moves with 0.2/pi cos(2 pi t / 10) m/s and the total energy is 0.0625 J, always.
# Usage, from the top of the repository: sh scenarios/sweeps/courant.sh [folder for the runs]
set -eu

here=$(CDPATH= cd -- "$(dirname -- "$0")" && pwd)
runs=${1:-runs/courant}
cargo build --release --quiet --manifest-path "$here/../../Cargo.toml"
mpm=${CARGO_TARGET_DIR:-$here/../../target}/release/mpm

printf '%-8s  %8s  %22s  %22s\n' courant steps 'rms velocity error (%)' 'energy at the end (J)'
for courant in 0.05 0.1 0.2 0.4 0.6 0.8 1.0 1.05; do
    folder=$runs/$courant
    if "$mpm" run "$here/../bar1d.toml" --set "time.courant=$courant" --output "$folder" --force --quiet --no-pictures 2>/dev/null
    then
        # the first row is the header; column 3 is the velocity of the centre of mass
        awk -F, -v courant="$courant" -v table="$folder/energy.csv" '
            NR > 1 { exact = 0.2 / pi() * cos(2 * pi() * $1 / 10); sum += ($3 - exact) ^ 2; rows += 1 }
            function pi() { return atan2(0, -1) }
            END {
                while ((getline line < table) > 0) {
                    split(line, number, ",")
                    if (number[1] == "time") { for (i in number) column[number[i]] = i }
                }
                split(last(table), number, ",")
                printf "%-8s  %8d  %22.4f  %22.6g\n", courant, number[column["step"]],
                    100 * sqrt(sum / rows) / (0.2 / pi()), number[column["total"]]
            }
            function last(name,   line, row) { close(name); while ((getline line < name) > 0) row = line; return row }
        ' "$folder/body_bar.csv"
    else
        printf '%-8s  %8s  the run failed\n' "$courant" -
    fi
done
