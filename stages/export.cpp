// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/cli/command_line.h"
#include "soslam/stage/stages.h"

int main(int argc, char** argv) {
  return soslam::StageMain<soslam::ExportOptions>(
      argc, argv,
      {.name = "soslam-export",
       .purpose =
           "Writes a map, or the ground truth, in the formats of other programs. Segments "
           "of a sequence have worlds of their own: of several, --trajectory, --ply, --gltf, "
           "--boxes, --colmap and --transforms write a file or folder each, map-3.ply for "
           "segment 3 of map.ply.",
       .inputs = {{"sequence", "sequence.json that the map was made from"},
                  {"map",
                   "map.json of soslam-optimise; without it, --trajectory, --colmap and "
                   "--transforms write the sequence's own poses",
                   false},
                  {"metrics",
                   "metrics.json that soslam-evaluate made of the map: tables (.csv) and scenes "
                   "(.glb) say which landmarks are found, ignored or false, and why",
                   false},
                  {"points",
                   "points.h5 of soslam-reconstruct or soslam-track, for --colmap; the poses that "
                   "are written place its points by their image points",
                   false},
                  {"dataset",
                   "dataset folder with the images: for --overlays, for the colours of points, and "
                   "for the paths in --transforms, which otherwise begin in that folder",
                   false}},
       .outputs =
           {{"trajectory", "camera poses to write, world_from_camera as TUM RGB-D has them (.txt)",
             false},
            {"ply", "bodies of the landmarks to write as one mesh (.ply)", false},
            {"gltf", "landmarks and trajectory to write as a scene (.glb, or .gltf)", false},
            {"coco", "boxes of the landmarks in each frame to write as COCO results (.json)",
             false},
            {"coco_dataset", "images and categories of these results to write (.json)", false},
            {"csv", "table of the landmarks to write (.csv)", false},
            {"boxes", "short table of the landmarks as upright boxes to write (.csv)", false},
            {"colmap",
             "folder to write a model of COLMAP into: cameras.txt, images.txt, points3D.txt", false,
             false, true},
            {"transforms", "cameras to write as nerfstudio has them (transforms.json)", false},
            {"overlays", "folder to write all images into, with the landmarks drawn (.jpg)", false,
             false, true}},
       .example = "soslam-export --sequence sequence.json --map map.json --gltf map.glb --csv "
                  "landmarks.csv"},
      &soslam::RunExport);
}
