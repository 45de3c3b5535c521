#!/usr/bin/env bash
# One table and two figures from a vanilla Ubuntu 24.04, without a parameter:
#     bash replicate.sh
# Shadows of one object by shadow maps of five sizes, the thesis's network and an occupancy field, both
# trained here, against exact rays, as in table 4.3 and figures 4.4 and 4.5 of Neural Shadow Ray Queries:
#     reports/table_4_3.md, reports/figure_4_4.png, reports/figure_4_5.png
# The object is a stand-in that is made on the spot. Seven minutes by the README's times with the
# installation, which downloads 3.5 GB, on two cores with AVX-512 BF16; 13 where they have AVX2 alone. What stops goes on where it was by the same command.
set -euo pipefail
cd "$(dirname "$0")"
if ! python3 -c 'import ensurepip' 2> /dev/null; then
  sudo apt-get update
  sudo apt-get install --yes python3-venv
fi
python3 -m venv .venv
.venv/bin/pip install --quiet -r envs/requirements.txt
.venv/bin/snakemake --cores all reports/table_4_3.csv
