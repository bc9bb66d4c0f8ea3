# SPDX-License-Identifier: BSD-3-Clause
# shellcheck shell=bash
# map.sh: what `soslam map` does, by which it is read: its settings are those of IMAGES, NETWORK, DETECTIONS, CAMERA,
# MODEL, EDITS and TRUTH, paths which may be empty and have any characters; SCALE and CAMERA_HEIGHT, numbers, which may be
# empty. The steps, and the files that tell that they are done, are in map.mk.

[[ -n $IMAGES ]] || refuse "images are not given; expected a folder of photos, or a video"
[[ -e $IMAGES ]] || refuse "images are '$IMAGES'; there is no such folder or video" 3
if [[ -z $NAME ]]; then  # that of the images, with letters, digits, _ and - only
  NAME=${IMAGES%"${IMAGES##*[!/]}"}  # without slashes at the end
  NAME=${NAME##*/}
  [[ -d $IMAGES ]] || NAME=${NAME%.*}
  NAME=$(LC_ALL=C tr -cs 'A-Za-z0-9-' '_' <<< "$NAME")
  NAME=${NAME#"${NAME%%[!_-]*}"}
  NAME=${NAME%_}
  NAME=${NAME:-photos}
fi
[[ -n $NETWORK || -n $DETECTIONS ]] ||
  refuse "expected a network, as yolox_nano.onnx (\`make network\` fetches it), or detections, a CSV file"
[[ -z $NETWORK || -z $DETECTIONS ]] || refuse "found a network and detections; expected one of them"
for file in "$NETWORK" "$DETECTIONS" "$CAMERA" "$EDITS"; do
  [[ -z $file || -f $file ]] || refuse "'$file': no such file" 3
done
[[ -z $MODEL || -d $MODEL ]] || refuse "model is '$MODEL'; there is no such folder" 3
true_files=()
[[ -z $TRUTH ]] || true_files=("$TRUTH"/{rgb.txt,groundtruth.txt,objects.json})
for file in "${true_files[@]}"; do
  [[ -f $file ]] || refuse "truth is '$TRUTH', which has no ${file##*/}; expected an annotated dataset folder of the same \
photos, with rgb.txt, groundtruth.txt and objects.json" 3
done
# The page compares all variants; the map is that of the first one, which needs the stage "optimise".
[[ $VARIANT != all ]] || VARIANT=OursSP
variants=$VARIANT
for variant in $variants; do
  [[ -f pipelines/variants/$variant.json || -f pipelines/pictures/variants/$variant.json ||
    -f $MAPS/$NAME/pipelines/variants/$variant.json ]] ||
    refuse "variant '$variant': no such variant; \`./soslam help\` lists them"
  [[ -f pipelines/variants/$variant.json || ! -f pipelines/pictures/variants/$variant.json || -f $SOSLAM_NETWORK ]] ||
    refuse "variant '$variant' looks at pictures by the network YOLOX-nano, and '$SOSLAM_NETWORK' is no such file; \
expected the one that \`./soslam network\` fetches, or, without detections, --network FILE" 3
done
makes_no_map="variant '$VARIANT': the first one makes no map; expected one that does, as OursSP"
for own in pipelines/{,pictures/}variants/${VARIANT%% *}.json; do
  [[ ! -f $own ]] || grep --quiet optimise "$own" || { grep --quiet extends "$own" && ! grep --quiet '"stages"' "$own"; } ||
    refuse "$makes_no_map"
done

for name in SCALE CAMERA_HEIGHT; do
  [[ ${!name} != .* ]] || declare "$name=0${!name}"
  [[ ${!name} =~ ^((0|[1-9][0-9]*)(\.[0-9]+)?)?$ && ! ${!name} =~ ^0(\.0+)?$ ]] ||
    refuse "${name,,} is '${!name}'; expected a number above 0, with a decimal point, as 1.6"
done
[[ -z $SCALE || -n $MODEL ]] ||
  refuse "scale is of the unit of a model; found no model, and the unit of COLMAP's own is another in each run"
[[ ${CAMERA_HEIGHT%.*} -le 100 ]] || refuse "camera_height is $CAMERA_HEIGHT; expected metres, at most 100"

export MAP_IMAGES=$IMAGES MAP_NETWORK=$NETWORK MAP_DETECTIONS=$DETECTIONS MAP_CAMERA=$CAMERA MAP_MODEL=$MODEL
export MAP_TRUTH=$TRUTH MAP_ROOT=$MAPS/$NAME MAP_NAME=$NAME MAP_THREADS=$THREADS

build
if [[ -z $MODEL ]] && ! command -v colmap > /dev/null; then
  pipelines/install-packages.sh colmap ||
    refuse "COLMAP is missing, which finds where the images were taken; install it, or give its finished model"
fi

mkdir -p "$MAP_ROOT/steps" || refuse "maps is '$MAPS'; expected a folder that you may write to"

# One map of a name at a time. What it started keeps the lock, so that a run that was killed does not write beside the
# next one.
exec 9> "$MAP_ROOT/.lock"
flock --nonblock 9 || { echo "map: waiting for another run of $NAME" && flock 9; }

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
[[ -z $CAMERA$MODEL ]] || options+=' --max_image_px 16384'
[[ -z $MODEL ]] || options+=' --max_frames 10000 --min_motion 0 --min_sharpness 0 --keep_exif_turn'
# These may be wrong, as where the camera looked down: the network tells, unless a camera is given, of upright images.
detect_options=''
[[ -z $MODEL || -n $CAMERA ]] || detect_options='--image_orientation surer'
export MAP_FRAMES_OPTIONS=$options MAP_DETECT_OPTIONS=$detect_options

# The list of photos and boxes, which begins with the path of the photos: if nothing else differs from the list of the
# map that is there, the photos have moved.
photos=$(listed "$IMAGES" && listed "$DETECTIONS" && echo "$options")
known=$(cat "$MAP_ROOT/steps/images.txt" 2> /dev/null || true)
have_moved() { [[ ${photos#*$'\n'} == "${known#*$'\n'}" ]]; }
[[ ! -e $MAP_ROOT/steps/frames || ${photos%%$'\n'*} == "${known%%$'\n'*}" ]] || have_moved ||
  refuse "$MAP_ROOT is of other images, '${known%%$'\n'*}'; expected another name"
echo "$photos" | keep "$MAP_ROOT/steps/images.txt"
listed "$CAMERA" | keep "$MAP_ROOT/steps/camera.txt"
listed "$MODEL" | keep "$MAP_ROOT/steps/model.txt"
listed "$NETWORK" | keep "$MAP_ROOT/steps/network.txt"
for file in "${true_files[@]}"; do listed "$file"; done | keep "$MAP_ROOT/steps/truth.txt"

# The settings: those of all maps of photos, with the orientation that the boxes refer to.
mkdir -p "$MAP_ROOT"/pipelines/{variants,datasets,priors,heads}
export MAP_STORED='^# {.*"image_orientation":"stored"'
keep_base() {
  local stored=''
  ! head -n 1 "$MAP_ROOT/data/$NAME/detections.csv" 2> /dev/null | grep --quiet "$MAP_STORED" ||
    stored=', "image_orientation": "stored"'
  sed "s/\"ground\": \"estimated\"/&, \"scale\": ${SCALE:-0}, \"camera_height_m\": ${CAMERA_HEIGHT:-0}/
    s/\"odometry_has_own_scale\": true/&$stored/" pipelines/photos/base.json | keep "$MAP_ROOT/pipelines/base.json"
}
keep_base
# Poses are held, so that odometry has no noise.
for from in pipelines/variants/*.json pipelines/pictures/variants/*[AR].json pipelines/priors/semantic_table.json; do
  sed '/"odometry_[rt]/d' "$from" | keep "$MAP_ROOT/${from/pictures\//}"
done
keep "$MAP_ROOT/pipelines/heads/yolox_nano.h5" < pipelines/pictures/heads/yolox_nano.h5

# The page shows the variants of this command; others may be of other settings. What they share stays.
for folder in "$MAP_ROOT/results/$NAME"/*/; do
  [[ " $VARIANT shared * " == *" $(basename "$folder") "* ]] || rm -r "$folder"
done

"$MAKE" --no-print-directory -f pipelines/map.mk BIN="$BIN"
keep_base
DATASET=$NAME DATA_ROOT=$MAP_ROOT/data RESULTS=$MAP_ROOT/results PIPELINES=$MAP_ROOT/pipelines
locked_run all
"$BIN/soslam-pages" --results "$RESULTS"

map=$RESULTS/$DATASET/${VARIANT%% *}/map.json
[[ -e $map ]] || refuse "$makes_no_map" 4
export_map "${map%/map.json}" "$MAP_ROOT/export" > /dev/null ||
  echo "map: not all files could be written to $MAP_ROOT/export" >&2
headline=$("$BIN/soslam-inspect" "$map" --headline)
mapfile -t headline <<< "$headline"
echo "${headline[0]}, page: $RESULTS/$DATASET/report.html"
[[ ${#headline[@]} -lt 2 ]] || echo "${headline[1]}"
