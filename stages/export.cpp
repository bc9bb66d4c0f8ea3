// SPDX-License-Identifier: BSD-3-Clause
#include "cli/command_line.h"
#include "stage/stages.h"

int main(int argc, char** argv) {
  return soslam::StageMain<soslam::ExportOptions>(
      argc, argv,
      {.name = "soslam-export",
       .purpose = "Writes a map, or the ground truth, in the formats of other programs. Segments "
                  "of a sequence have worlds of their own: of several, --trajectory, --ply and "
                  "--gltf write a file each, map-3.ply for segment 3 of map.ply.",
       .inputs = {{"sequence", "sequence.json that the map was made from"},
                  {"map",
                   "map.json of soslam-optimise; without it, --trajectory writes the "
                   "sequence's own poses",
                   false},
                  {"metrics",
                   "metrics.json that soslam-evaluate made of the map: tables (.csv) and scenes "
                   "(.glb) say which landmarks are found, ignored or false, and why",
                   false}},
       .outputs = {{"trajectory",
                    "camera poses to write, world_from_camera as TUM RGB-D has them (.txt)", false},
                   {"ply", "bodies of the landmarks to write as one mesh (.ply)", false},
                   {"gltf", "landmarks and trajectory to write as a scene (.glb, or .gltf)", false},
                   {"coco", "boxes of the landmarks in each frame to write as COCO results (.json)",
                    false},
                   {"coco_dataset", "images and categories of these results to write (.json)",
                    false},
                   {"csv", "table of the landmarks to write (.csv)", false}},
       .example = "soslam-export --sequence sequence.json --map map.json --gltf map.glb --csv "
                  "landmarks.csv"},
      &soslam::RunExport);
}
