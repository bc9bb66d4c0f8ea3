#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# map.sh: what `make map` does once the programs are built. Environment: MAP_IMAGES, MAP_NETWORK, MAP_DETECTIONS,
# MAP_CAMERA, MAP_MODEL: paths, which may be empty and have any characters; MAP_SCALE, MAP_CAMERA_HEIGHT: numbers, which
# may be empty; MAP_VARIANT: the variants; MAP_ROOT, MAP_NAME, MAP_THREADS, BIN and BUILD: names without spaces; MAKE.
# The steps, and the files that tell that they are done, are in map.mk.
set -euo pipefail

refuse() {
  echo "map: $1" >&2
  exit "${2:-2}"
}

[[ -n $MAP_IMAGES ]] || refuse "expected IMAGES=<folder of photos, or a video>"
[[ -e $MAP_IMAGES ]] || refuse "IMAGES='$MAP_IMAGES': no such folder or video" 3
[[ -n $MAP_NETWORK || -n $MAP_DETECTIONS ]] ||
  refuse "expected NETWORK=<file.onnx> (\`make network\` fetches one) or DETECTIONS=<detections.csv>"
[[ -z $MAP_NETWORK || -z $MAP_DETECTIONS ]] || refuse "found NETWORK and DETECTIONS; expected one of them"
for file in "$MAP_NETWORK" "$MAP_DETECTIONS" "$MAP_CAMERA"; do
  [[ -z $file || -f $file ]] || refuse "'$file': no such file" 3
done
# The page compares all variants; the map is that of the first one, which needs the stage "optimise".
for variant in $MAP_VARIANT; do
  [[ -f pipelines/variants/$variant.json || -f $MAP_ROOT/pipelines/variants/$variant.json ]] ||
    refuse "VARIANT='$variant': no such variant; \`make help\` lists them"
done
makes_no_map="VARIANT='$MAP_VARIANT': the first one makes no map; expected one that does, as OursSP"
own=pipelines/variants/${MAP_VARIANT%% *}.json
[[ ! -f $own ]] || grep --quiet --regexp=optimise --regexp=extends "$own" || refuse "$makes_no_map"
[[ -z $MAP_MODEL || -d $MAP_MODEL ]] || refuse "MODEL='$MAP_MODEL': no such folder" 3

for name in SCALE CAMERA_HEIGHT; do
  number=MAP_$name
  [[ ${!number} != .* ]] || declare "$number=0${!number}"
  [[ ${!number} =~ ^((0|[1-9][0-9]*)(\.[0-9]+)?)?$ && ! ${!number} =~ ^0(\.0+)?$ ]] ||
    refuse "$name='${!number}': expected a number above 0, as 1.6"
done
[[ -z $MAP_SCALE || -n $MAP_MODEL ]] ||
  refuse "SCALE is of the unit of MODEL; found no MODEL, and the unit of COLMAP's own is another in each run"
[[ ${MAP_CAMERA_HEIGHT%.*} -le 100 ]] || refuse "CAMERA_HEIGHT=$MAP_CAMERA_HEIGHT: expected metres, at most 100"

if [[ -z $MAP_MODEL ]] && ! command -v colmap > /dev/null; then
  pipelines/install-packages.sh colmap ||
    refuse "COLMAP is missing, which finds where the images were taken; install it, or give MODEL=<its finished model>"
fi

mkdir -p "$MAP_ROOT/steps" || refuse "expected MAPS=<a folder that you may write to>"

# One map of a name at a time. What it started keeps the lock, so that a run that was killed does not write beside the
# next one.
exec 9> "$MAP_ROOT/.lock"
flock --nonblock 9 || { echo "map: waiting for another run of $MAP_NAME" && flock 9; }

# keep FILE: replaces FILE by standard input where it differs, so that unchanged files keep their time.
keep() {
  cat > "$1.tmp"
  if cmp --quiet "$1.tmp" "$1"; then rm "$1.tmp"; else mv "$1.tmp" "$1"; fi
}

# listed PATH: a line for each file of it, which changes whenever the file does.
listed() {
  [[ -n $1 ]] || return 0
  realpath -- "$1"
  find -L "$(realpath -- "$1")" -maxdepth 2 -type f -printf '%P %s %T@\n' | LC_ALL=C sort
}

# A model or camera of others refers to the images as they are; a model does so for all of them, and
# may be of the stored ones, so that their EXIF data are needed.
options=''
[[ -z $MAP_CAMERA$MAP_MODEL ]] || options+=' --max_image_px 16384'
[[ -z $MAP_MODEL ]] || options+=' --max_frames 10000 --min_motion 0 --min_sharpness 0 --keep_exif_turn'
# These may be wrong, as where the camera looked down: the network tells, unless a camera is given, of upright images.
detect_options=''
[[ -z $MAP_MODEL || -n $MAP_CAMERA ]] || detect_options='--image_orientation surer'
export MAP_FRAMES_OPTIONS=$options MAP_DETECT_OPTIONS=$detect_options

# The list of photos and boxes, which begins with the path of the photos: if nothing else differs from the list of the
# map that is there, the photos have moved.
photos=$(listed "$MAP_IMAGES" && listed "$MAP_DETECTIONS" && echo "$options")
known=$(cat "$MAP_ROOT/steps/images.txt" 2> /dev/null || true)
have_moved() { [[ ${photos#*$'\n'} == "${known#*$'\n'}" ]]; }
[[ ! -e $MAP_ROOT/steps/frames || ${photos%%$'\n'*} == "${known%%$'\n'*}" ]] || have_moved ||
  refuse "$MAP_ROOT is of other images, '${known%%$'\n'*}'; expected NAME=<another name>"
echo "$photos" | keep "$MAP_ROOT/steps/images.txt"
listed "$MAP_CAMERA" | keep "$MAP_ROOT/steps/camera.txt"
listed "$MAP_MODEL" | keep "$MAP_ROOT/steps/model.txt"
listed "$MAP_NETWORK" | keep "$MAP_ROOT/steps/network.txt"

# The settings: those of all maps of photos, with the orientation that the boxes refer to.
mkdir -p "$MAP_ROOT"/pipelines/{variants,datasets,priors}
export MAP_STORED='^# {.*"image_orientation":"stored"'
keep_base() {
  local stored=''
  ! head -n 1 "$MAP_ROOT/data/$MAP_NAME/detections.csv" 2> /dev/null | grep --quiet "$MAP_STORED" ||
    stored=', "image_orientation": "stored"'
  sed "s/\"ground\": \"estimated\"/&, \"scale\": ${MAP_SCALE:-0}, \"camera_height_m\": ${MAP_CAMERA_HEIGHT:-0}/
    s/\"odometry_has_own_scale\": true/&$stored/" pipelines/photos/base.json | keep "$MAP_ROOT/pipelines/base.json"
}
keep_base
# Poses are held, so that odometry has no noise.
for file in variants/*.json priors/semantic_table.json; do
  for from in pipelines/$file; do sed '/"odometry_[rt]/d' "$from" | keep "$MAP_ROOT/${from}"; done
done

# The page shows the variants of this command; others may be of other settings. What they share stays.
for folder in "$MAP_ROOT/results/$MAP_NAME"/*/; do
  [[ " $MAP_VARIANT shared * " == *" $(basename "$folder") "* ]] || rm -r "$folder"
done

$MAKE --no-print-directory -f pipelines/map.mk
keep_base
$MAKE --no-print-directory run-built DATASET="$MAP_NAME" DATA_ROOT="$MAP_ROOT/data" RESULTS="$MAP_ROOT/results" \
  PIPELINES="$MAP_ROOT/pipelines" VARIANT="$MAP_VARIANT" THREADS="$MAP_THREADS" BUILD="$BUILD"
"$BIN/soslam-pages" --results "$MAP_ROOT/results"

map=$MAP_ROOT/results/$MAP_NAME/${MAP_VARIANT%% *}/map.json
[[ -e $map ]] || refuse "$makes_no_map" 4
headline=$("$BIN/soslam-inspect" "$map" --headline)
echo "$headline, page: $MAP_ROOT/results/$MAP_NAME/report.html"
