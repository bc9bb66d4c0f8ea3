# SPDX-License-Identifier: BSD-3-Clause
# detections.csv of the published boxes, a file per image with lines "number x1 y1 x2 y2 class score instance".
{
  echo frame,object_id,label,score,x1,y1,x2,y2
  frame=0
  while read -r stamp _; do
    [[ ! -e bbox/$stamp.txt ]] || awk -v frame="$frame" -v OFS=, '{print frame, 0, "cabinet", $7, $2, $3, $4, $5}' "bbox/$stamp.txt"
    frame=$((frame + 1))
  done < rgb.txt
} > detections.csv
