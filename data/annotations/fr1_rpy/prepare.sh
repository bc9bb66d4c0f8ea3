# SPDX-License-Identifier: BSD-3-Clause
# The published PNG as JPEG of quality 92, as the images were when they were annotated.
mkdir rgb
while read -r _ image; do
  pngtopnm "png/$(basename "$image" .jpg).png" | cjpeg -quality 92 -outfile "$image"
done < <(grep -v '^#' "$1/rgb.txt")
