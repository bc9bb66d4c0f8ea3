// SPDX-License-Identifier: BSD-3-Clause
// Edges, distance transform and nearest edge of an image of 640 x 480 pixels, against OpenCV's.
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <opencv2/imgproc.hpp>

#include "artefact/hdf5_artefact.h"
#include "benchmark/inputs.h"
#include "image/edge_maps.h"

namespace soslam {
namespace {

// Edges as in ComputeEdgeMaps.
cv::Mat Edges(const cv::Mat& grey) {
  const EdgesOptions options;
  cv::Mat blurred, edges;
  cv::GaussianBlur(grey, blurred, cv::Size(), options.blur_sigma_px);
  cv::Canny(blurred, edges, options.canny_low, options.canny_high, 3, true);
  return edges;
}

// Labels give nearest edge pixels, approximately; OpenCV has them with this mask only.
void OpenCvDistances(const cv::Mat& edges) {
  const cv::Mat background = edges == 0;
  cv::Mat distance, labels;
  cv::distanceTransform(background, distance, labels, cv::DIST_L2, cv::DIST_MASK_5,
                        cv::DIST_LABEL_PIXEL);
  benchmark::DoNotOptimize(distance.data);
  benchmark::DoNotOptimize(labels.data);
}

void ExactDistances(const cv::Mat& edges) {
  const cv::Mat nearest = NearestEdgeMap(edges);
  const cv::Mat distance = DistanceMap(nearest);
  benchmark::DoNotOptimize(nearest.data);
  benchmark::DoNotOptimize(distance.data);
}

void DetectEdges(benchmark::State& state) {
  const cv::Mat grey = RoomAImage();
  for (auto _ : state) benchmark::DoNotOptimize(Edges(grey).data);
}
BENCHMARK(DetectEdges)->Name("edges/blur_and_canny");

void Distances(benchmark::State& state, void (*distances)(const cv::Mat&)) {
  const cv::Mat edges = Edges(RoomAImage());
  for (auto _ : state) distances(edges);
}
BENCHMARK_CAPTURE(Distances, ours, ExactDistances)->Name("edges/distances/ours");
BENCHMARK_CAPTURE(Distances, opencv, OpenCvDistances)->Name("edges/distances/opencv");

void EdgesAndDistances(benchmark::State& state, void (*distances)(const cv::Mat&)) {
  const cv::Mat grey = RoomAImage();
  for (auto _ : state) distances(Edges(grey));
}
BENCHMARK_CAPTURE(EdgesAndDistances, ours, ExactDistances)->Name("edges/canny_and_distances/ours");
BENCHMARK_CAPTURE(EdgesAndDistances, opencv, OpenCvDistances)
    ->Name("edges/canny_and_distances/opencv");

// From an image file into the artefact.
void ImageToArtefact(benchmark::State& state, EdgeMaps (*maps)(const cv::Mat& grey)) {
  const auto path =
      std::filesystem::temp_directory_path() / fmt::format("soslam-bench-edges-{}.h5", getpid());
  EdgesWriter writer(path, {});
  int frame_id = 0;
  for (auto _ : state) writer.Write(frame_id++, maps(RoomAImage()));
}
// All maps of soslam-edges, with corners and the grey image.
BENCHMARK_CAPTURE(ImageToArtefact, all, [](const cv::Mat& grey) {
  return ComputeEdgeMaps(grey, EdgesOptions());
})->Name("edges/image_to_artefact");
// What OpenCV's functions make.
BENCHMARK_CAPTURE(ImageToArtefact, edges_and_distances, [](const cv::Mat& grey) {
  EdgeMaps maps;
  maps.edges = Edges(grey);
  maps.nearest_edge = NearestEdgeMap(maps.edges);
  maps.distance = DistanceMap(maps.nearest_edge);
  return maps;
})->Name("edges/canny_and_distances/ours_with_files");

// With corners: what soslam-edges computes for an image.
void AllMaps(benchmark::State& state) {
  const cv::Mat grey = RoomAImage();
  for (auto _ : state) benchmark::DoNotOptimize(ComputeEdgeMaps(grey, EdgesOptions()));
}
BENCHMARK(AllMaps)->Name("edges/all_maps_with_corners");

// What every user of the maps of a frame adds.
void Directions(benchmark::State& state) {
  const EdgeMaps maps = ComputeEdgeMaps(RoomAImage(), EdgesOptions());
  for (auto _ : state) benchmark::DoNotOptimize(FrameEdges(maps));
}
BENCHMARK(Directions)->Name("edges/directions");

}  // namespace
}  // namespace soslam
