# SPDX-License-Identifier: BSD-3-Clause
# A trajectory and a calibration for each sequence; of the calibration the camera that is used.
for trajectory in poses_orbslam3_stereo/*/CameraTrajectory.txt; do
  mv "$trajectory" "$(dirname "$trajectory").txt"
done
for calibration in calib/*.txt; do
  awk '$1 == "P2:" { $1 = $1; print }' "$calibration" > P2
  mv P2 "$calibration"
done
