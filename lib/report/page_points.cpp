// SPDX-License-Identifier: BSD-3-Clause
#include "report/page_points.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <utility>

#include "base/error.h"

namespace soslam {
namespace {

using nlohmann::json;

// Positions in PageSelection::detections, by frame and object.
std::map<std::pair<int, int>, size_t> PlacesOfDetections(const Sequence& sequence,
                                                         const PageSelection& selection) {
  std::map<std::pair<int, int>, size_t> places;
  for (size_t i = 0; i < selection.detections.size(); ++i) {
    const Detection& detection = sequence.detections[selection.detections[i]];
    places[{detection.frame_index, detection.object_index}] = i;
  }
  return places;
}

const MapPoint& PointAt(int index, const std::vector<MapPoint>& points) {
  if (static_cast<size_t>(index) < points.size()) return points[static_cast<size_t>(index)];
  throw InputError(fmt::format(
      "points.h5: has {} points; expected point {} of map.json among them: is the map of other "
      "points?",
      points.size(), index));
}

}  // namespace

json PagePoints(const MapEstimate& map, const std::vector<MapPoint>& points,
                const Sequence& sequence, const PageSelection& selection) {
  const auto places = PlacesOfDetections(sequence, selection);
  std::vector<json> page(selection.detections.size());
  for (const ObjectEstimate& estimate : map.objects) {
    for (const PointPosterior& posterior : estimate.points) {
      for (const PointObservation& observation : PointAt(posterior.index, points).observations) {
        const auto frame = FrameIndexOf(sequence, observation);
        if (!frame) continue;
        const auto place = places.find({static_cast<int>(*frame), estimate.object_index});
        const auto pixel = UndistortedPixel(sequence, observation);
        if (place == places.end() || !pixel) continue;
        json& of_detection = page[place->second];
        for (const json& coordinate : PagePixels({*pixel})) of_detection.push_back(coordinate);
        of_detection.push_back(std::lround(100.0 * posterior.responsibility));
      }
    }
  }
  return page;
}

json PagePointCounts(const ObjectEstimate& estimate) {
  if (estimate.points.empty()) return nullptr;
  double of_object = 0.0;
  for (const PointPosterior& point : estimate.points) of_object += point.responsibility;
  return {{"count", estimate.points.size()}, {"of_object", PageNumber(of_object)}};
}

}  // namespace soslam
