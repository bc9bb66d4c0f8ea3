// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

namespace soslam {

// An alignment of a map, as metrics.json has it.
inline nlohmann::json Alignment(const char* kind, double scale, int frames, double rmse_m) {
  return {{"kind", kind}, {"scale", scale}, {"frames", frames}, {"rmse_m", rmse_m}};
}

inline nlohmann::json Score(int found, double f1) {
  return {{"true_objects", 4},
          {"detectable", 3},
          {"landmarks", 5},
          {"ignored", 1},
          {"found", found},
          {"precision", 0.875},
          {"recall", 0.625},
          {"f1", f1},
          {"recall_of_detectable", 0.75},
          {"of_found",
           {{"iou_mean", 0.5},
            {"centre_m_mean", 0.125},
            {"centre_relative_mean", 0.25},
            {"log_size_abs_mean", {0.1, 0.2, nullptr}},
            {"log_scale_abs_mean", 0.0625},
            {"yaw_error_deg_mean", nullptr},
            {"up_error_deg_mean", 1.5},
            {"plane_offset_m_abs_mean", 0.01},
            {"plane_tilt_deg_mean", 2.5},
            {"labels_agree", 2},
            {"ids_known", 3},
            {"ids_agree", 1}}}};
}

// What tables read of the metrics.json of a map: a cup that is missed, and a television that is
// false.
inline nlohmann::json MapMetrics(const nlohmann::json& alignments) {
  return {
      {"odometry_source", "ORB-SLAM2"},
      {"map_quality",
       {{"alignments", alignments},
        {"scores", {Score(3, 0.75), Score(2, 0.5)}},
        {"in_frames", {{"iou_mean", 0.625}, {"iou_mean_in_world", 0.5}}},
        {"objects",
         {{{"true_object", 7}, {"label", "cup"}, {"reason", "not_detected"}, {"detail", "0 of 9"}},
          {{"true_object", 8}, {"label", "book"}, {"reason", nullptr}, {"detail", nullptr}}}},
        {"landmarks",
         {{{"object", 2},
           {"label", "tv"},
           {"fate", "false"},
           {"true_object", nullptr},
           {"reason", "background"},
           {"detail", ""}}}}}}};
}

}  // namespace soslam
