// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/appearance/appearance_file.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <memory>
#include <utility>

#include "soslam/artefact/hdf5_artefact.h"
#include "soslam/base/error.h"

namespace soslam {
namespace {

constexpr const char* kKind = "appearance";

}  // namespace

void WriteAppearance(const std::filesystem::path& path,
                     const std::vector<AppearanceRecord>& records, const ArtefactInfo& info) {
  std::vector<int> frame_ids, object_ids;
  std::vector<AzimuthCosts> azimuth_costs;
  std::vector<Eigen::Vector4f> log_ratios;
  std::vector<float> distances;
  cv::Mat descriptors(0, 0, CV_32F);
  for (const AppearanceRecord& record : records) {
    frame_ids.push_back(record.frame_id);
    object_ids.push_back(record.object_id);
    azimuth_costs.push_back(record.appearance.azimuth_costs);
    const auto& ratios = record.appearance.log_ratios;
    log_ratios.emplace_back(Eigen::Vector4f::Zero());
    if (ratios) log_ratios.back() << ratios->mean, ratios->sigma;
    distances.push_back(record.distance);
    descriptors.push_back(cv::Mat(1, static_cast<int>(record.descriptor.size()), CV_32F,
                                  const_cast<float*>(record.descriptor.data())));
  }
  Hdf5File file = CreateArtefact(path, kKind, info);
  const float correlation_deg =
      records.empty() ? 0.0F : records.front().appearance.direction_correlation_deg;
  file.WriteNumber("/", "direction_correlation_deg", correlation_deg);
  file.WriteVector("/frame_id", frame_ids);
  file.WriteVector("/object_id", object_ids);
  file.WriteRows("/azimuth_cost", azimuth_costs);
  file.WriteRows("/log_ratios", log_ratios);
  file.WriteVector("/distance", distances);
  file.WriteMatrix("/descriptor", descriptors);
  file.Close();
}

std::vector<AppearanceRecord> ReadAppearance(const std::filesystem::path& path) {
  const Hdf5File file = OpenArtefact(path, kKind);
  const auto frame_ids = file.ReadVector<int>("/frame_id");
  const int count = static_cast<int>(frame_ids.size());
  const auto correlation_deg =
      static_cast<float>(file.ReadNumber("/", "direction_correlation_deg"));
  if (!(correlation_deg >= 0.0F && correlation_deg <= 180.0F)) {
    throw InputError(fmt::format("{}: direction_correlation_deg is {}; expected 0 to 180",
                                 path.string(), correlation_deg));
  }
  const auto object_ids = file.ReadVector<int>("/object_id", count);
  const auto azimuth_costs = file.ReadRows<AzimuthCosts>("/azimuth_cost", count);
  const auto log_ratios = file.ReadRows<Eigen::Vector4f>("/log_ratios", count);
  const auto distances = file.ReadVector<float>("/distance", count);
  const cv::Mat descriptors = file.ReadMatrix("/descriptor", CV_32F, count);
  std::vector<AppearanceRecord> records;
  for (int i = 0; i < count; ++i) {
    AppearanceRecord record{
        frame_ids[i], object_ids[i], {azimuth_costs[i], {}, correlation_deg}, {}, distances[i]};
    const auto check = [&](bool is_right, const char* name, const char* expected) {
      if (is_right) return;
      throw InputError(
          fmt::format("{}: {}: row {}: expected {}", path.string(), name, i, expected));
    };
    check(azimuth_costs[i].allFinite() && azimuth_costs[i].minCoeff() >= 0.0F, "/azimuth_cost",
          "finite numbers of at least 0");
    if (log_ratios[i] != Eigen::Vector4f::Zero()) {
      check(log_ratios[i].allFinite() && log_ratios[i].tail<2>().minCoeff() > 1e-6F, "/log_ratios",
            "finite means and positive standard deviations, or zeros");
      record.appearance.log_ratios = {log_ratios[i].head<2>(), log_ratios[i].tail<2>()};
    }
    record.descriptor =
        Eigen::Map<const Eigen::VectorXf>(descriptors.ptr<float>(i), descriptors.cols);
    check(record.descriptor.allFinite(), "/descriptor", "finite numbers");
    check(std::isfinite(record.distance), "/distance", "a finite number");
    records.push_back(std::move(record));
  }
  return records;
}

void AddAppearance(const std::filesystem::path& path, Sequence* sequence) {
  std::map<std::pair<int, int>, Detection*> detections;  // by ids of frame and object
  for (Detection& detection : sequence->detections) {
    detections[{sequence->FrameOf(detection).id, sequence->ObjectOf(detection).id}] = &detection;
  }
  for (const AppearanceRecord& record : ReadAppearance(path)) {
    const auto found = detections.find({record.frame_id, record.object_id});
    if (found == detections.end()) {
      throw InputError(
          fmt::format("{}: has object {} in frame {}, which the sequence has not; "
                      "expected what soslam-appearance made of this sequence",
                      path.string(), record.object_id, record.frame_id));
    }
    if (found->second->appearance) {
      throw InputError(fmt::format("{}: has object {} in frame {} twice; expected each box once",
                                   path.string(), record.object_id, record.frame_id));
    }
    found->second->appearance = std::make_shared<const BoxAppearance>(record.appearance);
  }
}

}  // namespace soslam
