// SPDX-License-Identifier: BSD-3-Clause
// evaluate_map SEQUENCE MAP: how good a map is, from the files that the stages write.
#include <cstdio>

#include "soslam/artefact/files.h"
#include "soslam/evaluation/metrics.h"

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const soslam::Sequence sequence = soslam::ReadSequence(argv[1]);
  const soslam::Metrics metrics = soslam::EvaluateMap(sequence, soslam::ReadMap(argv[2], sequence));
  for (const soslam::ObjectMetrics& object : metrics.objects) {
    std::printf("%s: IoU %.3f\n", sequence.objects[object.object_index].label.c_str(), object.iou);
  }
  return metrics.objects.empty() ? 1 : 0;
}
