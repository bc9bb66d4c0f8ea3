// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/artefact/hdf5_artefact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <opencv2/core.hpp>

#include "soslam/artefact/files.h"
#include "soslam/base/error.h"
#include "soslam/base/parallel.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/random.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

EdgeMaps MapsOfRandomRectangles() {
  cv::Mat grey(48, 64, CV_8UC1, cv::Scalar(30));
  for (int i = 0; i < 4; ++i) {
    const cv::Rect rectangle(static_cast<int>(RandomUniform(5, 40)),
                             static_cast<int>(RandomUniform(5, 25)), 15, 12);
    grey(rectangle) = RandomUniform(60, 250);
  }
  return ComputeEdgeMaps(grey, {});
}

void ExpectSame(const EdgeMaps& a, const EdgeMaps& b) {
  const auto same = [](const cv::Mat& m, const cv::Mat& n) {
    return m.type() == n.type() && m.size() == n.size() &&
           std::equal(m.datastart, m.dataend, n.datastart);
  };
  EXPECT_TRUE(same(a.grey, b.grey));
  EXPECT_TRUE(same(a.edges, b.edges));
  EXPECT_TRUE(same(a.distance, b.distance));
  EXPECT_TRUE(same(a.nearest_edge, b.nearest_edge));
  EXPECT_EQ(a.corners, b.corners);
}

class EdgesFileTest : public FolderTest {
 protected:
  std::filesystem::path Write(const std::string& name, const EdgeMaps& maps) {
    EdgesWriter writer(folder_ / name, {});
    writer.Write(12, maps);
    writer.Commit();
    return folder_ / name;
  }
  // An artefact with nothing but a header.
  std::filesystem::path WriteHeader(const std::string& header) {
    Hdf5File file = Hdf5File::Create(folder_ / "header.h5");
    file.WriteText("/", "artefact", header);
    file.Close();
    return folder_ / "header.h5";
  }
};

// Also to threads side by side. (Where the HDF5 library knows threads, it would take turns by
// itself.)
TEST_F(EdgesFileTest, FramesComeBackExactly) {
  const std::vector<int> ids = {7, 8, 9, 10, 11, 20, 999999, 1234567};
  std::vector<EdgeMaps> maps;
  EdgesWriter writer(folder_ / "edges.h5", {});
  for (const int id : ids) {
    maps.push_back(MapsOfRandomRectangles());
    writer.Write(id, maps.back());
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "edges.h5")) << "before it is complete";
  writer.Commit();
  const EdgesReader reader(folder_ / "edges.h5");
  EXPECT_EQ(reader.FrameIds(), ids);
  EXPECT_TRUE(reader.Has(1234567));
  EXPECT_FALSE(reader.Has(12));
  std::vector<EdgeMaps> read(maps.size());
  ParallelFor(ids.size(), 4, [&](int i) { read[i] = reader.Read(ids[i]); });
  for (size_t i = 0; i < maps.size(); ++i) ExpectSame(read[i], maps[i]);
  ExpectError<InputError>([&] { reader.Read(12); }, {"edges.h5", "/frames/000012", "missing"});
}

TEST_F(EdgesFileTest, NearestEdgesOutsideTheImageAreRefused) {
  for (const cv::Vec2s& outside : {cv::Vec2s(-1, 3), cv::Vec2s(3, -7), cv::Vec2s(3, 32000)}) {
    EdgeMaps maps = MapsOfRandomRectangles();
    maps.nearest_edge.at<cv::Vec2s>(2, 1) = outside;
    const auto file = Write("edges.h5", maps);
    ExpectError<InputError>([&] { EdgesReader(file).Read(12); },
                            {"edges.h5", "nearest_edge", "(1, 2)", "expected a pixel"});
  }
}

TEST_F(EdgesFileTest, CutShortAnywhereIsRefused) {
  const std::string whole = FileBytes(Write("edges.h5", MapsOfRandomRectangles()));
  for (size_t size = 0; size < whole.size(); size += 37) {
    WriteBytes(folder_ / "cut.h5", whole.substr(0, size));
    ExpectError<InputError>([&] { EdgesReader(folder_ / "cut.h5").Read(12); }, {"cut.h5"});
  }
}

TEST_F(EdgesFileTest, OtherHeadersAreRefused) {
  ExpectBadTexts({{R"({"kind": "symmetry", "schema_version": [1, 0]})", {"symmetry", "edges"}},
                  {"", {"header"}},
                  {"{", {"header"}}},
                 "header.h5",
                 [&](const std::string& header) { EdgesReader reader(WriteHeader(header)); });
  Hdf5File::Create(folder_ / "header.h5").Close();
  ExpectError<InputError>([&] { EdgesReader(folder_ / "header.h5"); }, {"header.h5", "header"});
}

TEST_F(EdgesFileTest, MapsOfDifferentSizesAreRefused) {
  EdgeMaps maps = MapsOfRandomRectangles();
  maps.distance = maps.distance.rowRange(0, 40);
  const EdgesReader reader(Write("edges.h5", maps));
  ExpectError<InputError>([&] { reader.Read(12); },
                          {"edges.h5", "/frames/000012/distance", "40 x 64", "48 x 64"});
}

SymmetryRecord FullRecord() {
  SymmetryRecord record;
  record.frame_id = 12;
  record.object_id = 3;
  record.yaw = {-0.1, 0.0, 0.1};
  record.cost["grey"] = {1.0, 2.0, std::nan("")};
  record.cost["improved_dt"] = {0.5, 0.25, 0.125};
  record.samples = {{1.5F, 2.0F}, {3.0F, 4.25F}};
  record.mirrored = {{10.5F, 2.0F}, {8.0F, 4.0F}};
  record.initial_yaw = -0.1;
  record.refined_yaw = 0.1;
  record.yaw_sigma = 0.02;
  record.mirror_planes = 2;
  record.true_yaw = 0.09;
  return record;
}

// The record of an observation without landmark and ground truth.
SymmetryRecord BareRecord() {
  SymmetryRecord record;
  record.frame_id = 2;
  record.object_id = 30;
  return record;
}

class SymmetryFileTest : public FolderTest {
 protected:
  void ExpectRefused(const SymmetryRecord& record, const std::vector<std::string>& words) const {
    WriteSymmetry(folder_ / "symmetry.h5", {record}, {});
    ExpectError<InputError>([&] { ReadSymmetry(folder_ / "symmetry.h5"); }, words);
  }
};

TEST_F(SymmetryFileTest, RecordsComeBackInOrder) {
  WriteSymmetry(folder_ / "symmetry.h5", {FullRecord(), BareRecord()}, {});
  const auto records = ReadSymmetry(folder_ / "symmetry.h5");
  ASSERT_EQ(records.size(), 2U);
  EXPECT_EQ(records[0].object_id, 30);
  EXPECT_TRUE(records[0].yaw.empty());
  EXPECT_TRUE(std::isnan(records[0].refined_yaw));
  EXPECT_FALSE(records[0].true_yaw);
  const SymmetryRecord expected = FullRecord();
  EXPECT_EQ(records[1].object_id, 3);
  EXPECT_EQ(records[1].cost.at("improved_dt"), expected.cost.at("improved_dt"));
  EXPECT_EQ(records[1].mirrored, expected.mirrored);
  EXPECT_EQ(records[1].mirror_planes, expected.mirror_planes);
  WriteSymmetry(folder_ / "in_order.h5", {BareRecord(), FullRecord()}, {});
  WriteSymmetry(folder_ / "again.h5", records, {});
  EXPECT_TRUE(FileBytes(folder_ / "again.h5") == FileBytes(folder_ / "in_order.h5"));
}

TEST_F(SymmetryFileTest, RefusesAnImpossibleNumberOfMirrorPlanes) {
  SymmetryRecord record = FullRecord();
  record.mirror_planes = 7;
  ExpectRefused(record, {"symmetry.h5", "mirror_planes", "7", "0, 1 or 2"});
}

TEST_F(SymmetryFileTest, CurvesOfAnotherLengthAreRefused) {
  SymmetryRecord record = FullRecord();
  record.cost["grey"].pop_back();
  ExpectRefused(record, {"/observations/000012_000003/cost/grey", "expected 3"});
}

std::vector<MapPoint> TwoPoints() {
  return {{{1.0, 2.0, 3.0}, 0.25, {{0, {10.0, 20.5}}, {7, {11.0, 21.0}}}},
          {{-1.0, 0.5, 1e-3}, 0.0, {{3, {-0.5, 639.0}}}}};
}

class PointsFileTest : public FolderTest {
 protected:
  // The error of the reader for two points, changed.
  void ExpectRefused(const std::function<void(std::vector<MapPoint>*)>& change,
                     const std::vector<std::string>& parts) {
    std::vector<MapPoint> points = TwoPoints();
    change(&points);
    WritePoints(folder_ / "points.h5", points, {});
    ExpectError<InputError>([&] { ReadPoints(folder_ / "points.h5"); }, parts);
  }

  // A file with two points and an observation each.
  void WriteArrays(const std::vector<int>& begins, int pixel_rows = 2) {
    Hdf5File file = CreateArtefact(folder_ / "points.h5", "points", {});
    file.WriteMatrix("/position", cv::Mat::zeros(2, 3, CV_64FC1));
    file.WriteVector("/reprojection_error_px", std::vector<double>{0.0, 0.0});
    file.WriteVector("/observation_begin", begins);
    file.WriteVector("/observation_frame", std::vector<int>{0, 1});
    file.WriteMatrix("/observation_pixel", cv::Mat::zeros(pixel_rows, 2, CV_64FC1));
    file.Close();
  }
};

TEST_F(PointsFileTest, PointsComeBack) {
  WritePoints(folder_ / "points.h5", TwoPoints(), {});
  const auto points = ReadPoints(folder_ / "points.h5");
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0].position_in_world, Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(points[1].observations.at(0).pixel, Eigen::Vector2d(-0.5, 639.0));
  WritePoints(folder_ / "again.h5", points, {});
  EXPECT_TRUE(FileBytes(folder_ / "again.h5") == FileBytes(folder_ / "points.h5"));
}

TEST_F(PointsFileTest, ImpossibleNumbersAreRefused) {
  ExpectRefused([](auto* points) { (*points)[1].position_in_world.y() = std::nan(""); },
                {"points.h5", "/position", "row 1", "nan", "finite"});
  ExpectRefused([](auto* points) { (*points)[0].observations[1].pixel.x() = 1.0 / 0.0; },
                {"/observation_pixel", "row 1", "inf", "finite"});
  ExpectRefused([](auto* points) { (*points)[0].reprojection_error_px = -1.0; },
                {"/reprojection_error_px", "row 0", "-1", "at least 0"});
  ExpectRefused([](auto* points) { (*points)[1].reprojection_error_px = std::nan(""); },
                {"/reprojection_error_px", "row 1", "nan"});
  ExpectRefused([](auto* points) { (*points)[1].observations[0].frame_id = -4; },
                {"/observation_frame", "row 2", "-4", "at least 0"});
}

TEST_F(PointsFileTest, ArraysThatDoNotFitAreRefused) {
  const auto read = [&] { ReadPoints(folder_ / "points.h5"); };
  WriteArrays({0, 1, 2});
  EXPECT_NO_THROW(read());
  WriteArrays({1, 1, 2});
  ExpectError<InputError>(read, {"/observation_begin", "row 0", "found 1", "expected 0"});
  WriteArrays({0, 5, 2});
  ExpectError<InputError>(read, {"/observation_begin", "row 2", "found 2", "above"});
  WriteArrays({0, 1, 1});
  ExpectError<InputError>(read, {"/observation_begin", "found 1", "number of rows"});
  WriteArrays({0, 2});
  ExpectError<InputError>(read, {"/observation_begin", "expected 3"});
  WriteArrays({0, 1, 2}, 3);
  ExpectError<InputError>(read, {"/observation_pixel", "expected 2 x 2"});
}

std::vector<PointTrack> TwoTracks() {
  return {{{{0, {10.0, 20.5}}, {7, {11.0, 21.0}}, {8, {-0.5, 639.0}}}},
          {{{3, {1.0, 2.0}}, {7, {4.0, 5.0}}}}};
}

class MatchesFileTest : public FolderTest {
 protected:
  // The error of the reader for two tracks, changed.
  void ExpectRefused(const std::function<void(std::vector<PointTrack>*)>& change,
                     const std::vector<std::string>& parts) {
    std::vector<PointTrack> tracks = TwoTracks();
    change(&tracks);
    WriteMatches(path_, ImageMatches{tracks}, {});
    ExpectError<InputError>([&] { ReadMatches(path_); }, parts);
  }

  // A file of three observations.
  void WriteArrays(const std::vector<int>& begins, int pixel_rows = 3) {
    Hdf5File file = CreateArtefact(path_, "matches", {});
    file.WriteVector("/observation_begin", begins);
    file.WriteVector("/observation_frame", std::vector<int>{0, 1, 2});
    file.WriteMatrix("/observation_pixel", cv::Mat::zeros(pixel_rows, 2, CV_64FC1));
    file.WriteRows("/colours", std::vector<BoxColours>());
    file.Close();
  }

  std::filesystem::path path_ = folder_ / "matches.h5";
};

TEST_F(MatchesFileTest, TracksComeBack) {
  const BoxColours colours = BoxColours::LinSpaced(0, 255);
  WriteMatches(path_, {TwoTracks(), {BoxColours::Zero(), colours}}, {});
  const ImageMatches matches = ReadMatches(path_);
  const std::vector<PointTrack>& tracks = matches.tracks;
  ASSERT_EQ(matches.colours.size(), 2u);
  EXPECT_EQ(matches.colours[1], colours);
  ASSERT_EQ(tracks.size(), 2u);
  ASSERT_EQ(tracks[0].observations.size(), 3u);
  EXPECT_EQ(tracks[0].observations[2].pixel, Eigen::Vector2d(-0.5, 639.0));
  EXPECT_EQ(tracks[1].observations.at(1).frame_id, 7);
  WriteMatches(folder_ / "again.h5", matches, {});
  EXPECT_TRUE(FileBytes(folder_ / "again.h5") == FileBytes(path_));
  WriteMatches(path_, {}, {});
  EXPECT_TRUE(ReadMatches(path_).tracks.empty());
}

TEST_F(MatchesFileTest, ImpossibleTracksAreRefused) {
  ExpectRefused([](auto* tracks) { (*tracks)[0].observations[1].pixel.x() = std::nan(""); },
                {"matches.h5", "/observation_pixel", "row 1", "nan", "finite"});
  ExpectRefused([](auto* tracks) { (*tracks)[1].observations[0].frame_id = -4; },
                {"/observation_frame", "row 3", "-4", "at least 0"});
  ExpectRefused([](auto* tracks) { (*tracks)[1].observations[1].frame_id = 3; },
                {"/observation_frame", "row 4", "found 3", "more than the id above"});
  ExpectRefused([](auto* tracks) { (*tracks)[0].observations.resize(1); },
                {"/observation_begin", "row 1", "found 1", "two more"});
  ExpectRefused([](auto* tracks) { (*tracks)[1].observations.clear(); },
                {"/observation_begin", "row 2", "found 3", "two more"});
}

TEST_F(MatchesFileTest, ArraysThatDoNotFitAreRefused) {
  const auto read = [&] { ReadMatches(path_); };
  WriteArrays({0, 3});
  EXPECT_NO_THROW(read());
  WriteArrays({});
  ExpectError<InputError>(read, {"/observation_begin", "row 0", "found none", "expected 0"});
  WriteArrays({1, 3});
  ExpectError<InputError>(read, {"/observation_begin", "row 0", "found 1", "expected 0"});
  WriteArrays({0, 5, 3});
  ExpectError<InputError>(read, {"/observation_begin", "row 2", "found 3", "above"});
  WriteArrays({0, 2});
  ExpectError<InputError>(read, {"/observation_begin", "found 2", "number of rows"});
  WriteArrays({0, 3}, 2);
  ExpectError<InputError>(read, {"/observation_pixel", "expected 3 x 2"});
  WritePoints(path_, TwoPoints(), {});
  ExpectError<InputError>(read, {"matches.h5", "points", "matches"});
}

}  // namespace
}  // namespace soslam
