# SPDX-License-Identifier: BSD-3-Clause
# All but odometry.txt and detections_yolov5.json is what fr2_desk_11 has.
other=$(dirname "$1")/fr2_desk_11
bash -euo pipefail "$other/prepare.sh" "$other"
rm detections.csv
cp "$other"/{camera,objects,planes}.json .
