// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/association/options.h"
#include "soslam/cli/command_line.h"
#include "soslam/stage/stages.h"

int main(int argc, char** argv) {
  return soslam::StageMain<soslam::AssociateOptions>(
      argc, argv,
      {.name = "soslam-associate",
       .purpose = "Finds out which detections are of the same object, without their ids.",
       .inputs = {{"sequence", "sequence.json of soslam-import"},
                  {"table", "semantic table with the size ratio of each label"},
                  {"matches",
                   "matches.h5 of soslam-match; needed when the setting shared_points is true",
                   false},
                  {"edits",
                   "edits.json: corrections by hand, {\"edits\": [...]}, each with \"edit\" (join, "
                   "split, delete, delete_boxes, rename, size), \"boxes\": [{\"image\": \"a.png\", "
                   "\"box\": [x_min, y_min, x_max, y_max]}, ...], and label or depth_m, width_m, "
                   "height_m; see docs/association.md",
                   false}},
       .outputs = {{"output", "sequence to write, with the objects found"},
                   {"associations", "associations.json to write: what was decided, and why"}},
       .example = "soslam-associate --association estimated --sequence sequence.json --table "
                  "pipelines/priors/semantic_table.json --output associated.json "
                  "--associations associations.json"},
      &soslam::RunAssociate);
}
