// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/symmetry_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "artefact/atomic_file.h"
#include "artefact/hdf5_artefact.h"
#include "base/error.h"

namespace soslam {
namespace {

constexpr const char* kKind = "symmetry";
constexpr const char* kObservations = "/observations";

void WriteRecord(const SymmetryRecord& record, Hdf5File* file) {
  const std::string group =
      fmt::format("{}/{:06d}_{:06d}", kObservations, record.frame_id, record.object_id);
  file->WriteVector(group + "/yaw", record.yaw);
  file->WriteGroup(group + "/cost");
  for (const auto& [descriptor, cost] : record.cost) {
    file->WriteVector(group + "/cost/" + descriptor, cost);
  }
  WritePixels(group + "/samples", record.samples, file);
  WritePixels(group + "/mirrored", record.mirrored, file);
  file->WriteNumber(group, "frame_id", record.frame_id);
  file->WriteNumber(group, "object_id", record.object_id);
  file->WriteNumber(group, "initial_yaw", record.initial_yaw);
  file->WriteNumber(group, "refined_yaw", record.refined_yaw);
  if (record.yaw_sigma) file->WriteNumber(group, "yaw_sigma", *record.yaw_sigma);
  if (record.mirror_planes) file->WriteNumber(group, "mirror_planes", *record.mirror_planes);
  if (record.true_yaw) file->WriteNumber(group, "true_yaw", *record.true_yaw);
}

int ReadMirrorPlanes(const Hdf5File& file, const std::string& group) {
  const double value = file.ReadNumber(group, "mirror_planes");
  for (const int planes : {0, 1, 2}) {
    if (value == planes) return planes;
  }
  throw InputError(fmt::format("{}: {}/mirror_planes: found {}; expected 0, 1 or 2",
                               file.path().string(), group, value));
}

SymmetryRecord ReadRecord(const Hdf5File& file, const std::string& group) {
  SymmetryRecord record;
  record.frame_id = static_cast<int>(std::lround(file.ReadNumber(group, "frame_id")));
  record.object_id = static_cast<int>(std::lround(file.ReadNumber(group, "object_id")));
  record.yaw = file.ReadVector<double>(group + "/yaw");
  const int yaws = static_cast<int>(record.yaw.size());
  for (const std::string& descriptor : file.Children(group + "/cost")) {
    record.cost[descriptor] = file.ReadVector<double>(group + "/cost/" + descriptor, yaws);
  }
  record.samples = ReadPixels(file, group + "/samples");
  record.mirrored = ReadPixels(file, group + "/mirrored", static_cast<int>(record.samples.size()));
  record.initial_yaw = file.ReadNumber(group, "initial_yaw");
  record.refined_yaw = file.ReadNumber(group, "refined_yaw");
  if (file.HasAttribute(group, "yaw_sigma")) {
    record.yaw_sigma = file.ReadNumber(group, "yaw_sigma");
  }
  if (file.HasAttribute(group, "mirror_planes")) {
    record.mirror_planes = ReadMirrorPlanes(file, group);
  }
  if (file.HasAttribute(group, "true_yaw")) record.true_yaw = file.ReadNumber(group, "true_yaw");
  return record;
}

}  // namespace

void WriteSymmetry(const std::filesystem::path& path, const std::vector<SymmetryRecord>& records,
                   const ArtefactInfo& info) {
  AtomicFile atomic(path);
  Hdf5File file = Hdf5File::Create(atomic.TemporaryPath(), path);
  WriteArtefactHeader(kKind, info, &file);
  file.WriteGroup(kObservations);
  for (const SymmetryRecord& record : records) WriteRecord(record, &file);
  file.Close();
  atomic.Commit();
}

std::vector<SymmetryRecord> ReadSymmetry(const std::filesystem::path& path) {
  const Hdf5File file = OpenArtefact(path, kKind);
  std::vector<SymmetryRecord> records;
  for (const std::string& name : file.Children(kObservations)) {
    records.push_back(ReadRecord(file, fmt::format("{}/{}", kObservations, name)));
  }
  const auto key = [](const SymmetryRecord& r) { return std::pair(r.frame_id, r.object_id); };
  std::sort(records.begin(), records.end(),
            [&](const auto& a, const auto& b) { return key(a) < key(b); });
  return records;
}

}  // namespace soslam
