#!/usr/bin/env bash
# train.sh NETWORK FOLDER BIN: trains the head of docs/appearance.md for the inner layers of NETWORK (YOLOX-nano) on
# renders of furniture; FOLDER gets models, renders, log and head.h5. An hour on two cores.
set -euo pipefail

network=$1 folder=$2 bin=$3
here=$(dirname "$0")
layers='Mul 36,Mul 68' # the ends of dark4 and of C3_n3
models=/usr/share/sweethome3d/furniture

[[ -e $network ]] || { echo "train-head: '$network': no such network (./soslam network fetches it)" >&2; exit 3; }
# What was rendered for another network, or of other groups, is no use.
folder=$folder/$(cat "$network" "$here/groups.json" | sha256sum | cut -c1-10)
mkdir -p "$folder"
for library in "$models"/*.sh3f; do
  unpacked=$folder/furniture/$(basename "$library" .sh3f)
  [[ -e $unpacked/PluginFurnitureCatalog.properties ]] || {
    rm -rf "$unpacked" "$unpacked.part" && mkdir -p "$unpacked.part" && bsdtar -xf "$library" -C "$unpacked.part"
    mv "$unpacked.part" "$unpacked"
  }
done
render() {
  [[ ! -e $1 ]] || return 0
  "$bin/soslam-training-crops" --furniture "$folder/furniture" --groups "$here/groups.json" --network "$network" \
    --layers "$layers" --output "$@"
}
render "$folder/crops.h5" --crops 24000 --sheets "$folder/sheets"
render "$folder/calibration.h5" --crops 4000 --views_per_look 8 --seed 77
/usr/bin/python3 "$here/train_head.py" --crops "$folder/crops.h5" --calibration "$folder/calibration.h5" \
  --groups "$here/groups.json" --output "$folder/head.h5" | tee "$folder/train.log"
sha256sum "$folder/head.h5"
