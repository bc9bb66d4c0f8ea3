#!/usr/bin/env bash
# status.sh [DATASET]: for each variant of a dataset (default: of every dataset that ran), whether
# each of its stages is done, stale or missing. Reads BIN and RESULTS.
set -euo pipefail

stages=(import associate planes edges initialise refine optimise evaluate)

# print_row FIRST CELL...
print_row() {
  printf '%-16s' "$1"
  shift
  printf ' %-10s' "$@"
  printf '\n'
}

# state_of DATASET INSTANCE
state_of() {
  local done_stamp="$RESULTS/$1/shared/$2/done"
  if [[ ! -e $done_stamp ]]; then
    echo missing
  elif make -q -f "$RESULTS/$1/plan.mk" BIN="$BIN" "$done_stamp" > /dev/null 2>&1; then
    echo 'done'
  else
    echo stale
  fi
}

# Plans anew, so that changed settings count; without the executable the last plan has to do.
refresh_plan() {
  local folder
  folder=$(sed -n 's/^dataset := //p' "$RESULTS/$1/plan.mk")
  [[ -x $BIN/soslam-plan && -d $folder ]] || return 0
  "$BIN/soslam-plan" --dataset "$folder" --name "$1" --pipelines pipelines --results "$RESULTS"
}

print_dataset() {
  local dataset=$1 variant_list row stage instance
  declare -A states
  print_row "$dataset" "${stages[@]}"
  for variant_list in "$RESULTS/$dataset"/*/stages.txt; do
    row=()
    for stage in "${stages[@]}"; do
      instance=$(grep "^$stage-" "$variant_list") || { row+=(-) && continue; }
      if [[ -z ${states[$instance]:-} ]]; then
        states[$instance]=$(state_of "$dataset" "$instance")
      fi
      row+=("${states[$instance]}")
    done
    print_row "  $(basename "$(dirname "$variant_list")")" "${row[@]}"
  done
}

unset MAKEFLAGS MAKELEVEL MFLAGS
shopt -s nullglob
datasets=("$@")
if [[ $# -eq 0 ]]; then
  for plan in "$RESULTS"/*/plan.mk; do
    datasets+=("$(basename "$(dirname "$plan")")")
  done
fi
if [[ ${#datasets[@]} -eq 0 ]]; then
  echo "nothing ran yet: there is no $RESULTS/<dataset>/plan.mk"
fi
for dataset in "${datasets[@]}"; do
  refresh_plan "$dataset"
  print_dataset "$dataset"
done
