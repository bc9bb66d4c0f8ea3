# SPDX-License-Identifier: BSD-3-Clause
# detections.csv of the published boxes that ids.csv gives to objects. The boxes are JSON in one line, of which each {
# begins an image or a box.
tr '{' '\n' < detections_yolov5.json | awk '
  BEGIN { FS = ","; print "frame,object_id,label,score,x1,y1,x2,y2" }
  FILENAME ~ /rgb.txt$/ { if ($0 !~ /^#/) { split($0, words, " "); frame_of[words[1]] = frames++ } next }
  FILENAME ~ /ids.csv$/ { owner[$1, $2] = $3 "," $4; next }
  /"file_name"/ { match($0, /[0-9.]+\.png/); frame = frame_of[substr($0, RSTART, RLENGTH - 4)]; box = 0; next }
  /"bbox"/ {
    if ((frame, box) in owner) {
      gsub(/[^0-9.,]/, "")
      printf "%d,%s,%.3f,%.1f,%.1f,%.1f,%.1f\n", frame, owner[frame, box], $2, $3, $4, $5, $6
    }
    ++box
  }' "$1/rgb.txt" "$1/ids.csv" - > detections.csv
# groundtruth.txt: our poses, of which only the differences from the published trajectory are ours to give.
{
  echo '# timestamp tx ty tz qx qy qz qw   (T_world_camera, metres; see README)'
  awk '
    /^#/ { next }
    FNR == NR { for (i = 2; i <= 8; ++i) difference[$1, i] = $i; known[$1]; next }
    $1 in known {
      printf "%s", $1
      for (i = 2; i <= 8; ++i) printf " %.6f", $i + difference[$1, i]
      print ""
    }' "$1/groundtruth_from_odometry.txt" odometry.txt
} > groundtruth.txt
