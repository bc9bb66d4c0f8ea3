// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/core.hpp>

#include "artefact/hdf5_artefact.h"
#include "base/error.h"
#include "base/parallel.h"
#include "support/expect_error.h"
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

class EdgesFileTest : public testing::Test {
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
  TemporaryFolder folder_;
};

TEST_F(EdgesFileTest, FramesComeBackExactly) {
  const EdgeMaps first = MapsOfRandomRectangles();
  const EdgeMaps second = MapsOfRandomRectangles();
  EdgesWriter writer(folder_ / "edges.h5", {});
  writer.Write(7, first);
  writer.Write(1234567, second);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "edges.h5")) << "before it is complete";
  writer.Commit();

  const EdgesReader reader(folder_ / "edges.h5");
  EXPECT_TRUE(reader.Has(7));
  EXPECT_TRUE(reader.Has(1234567));
  EXPECT_FALSE(reader.Has(8));
  ExpectSame(reader.Read(7), first);
  ExpectSame(reader.Read(1234567), second);
  ExpectError<InputError>([&] { reader.Read(8); }, {"edges.h5", "/frames/000008", "missing"});
}

// (Where the HDF5 library knows threads, it would take turns by itself.)
TEST_F(EdgesFileTest, ThreadsReadSideBySide) {
  std::vector<EdgeMaps> maps;
  EdgesWriter writer(folder_ / "edges.h5", {});
  for (int i = 0; i < 8; ++i) {
    maps.push_back(MapsOfRandomRectangles());
    writer.Write(i, maps.back());
  }
  writer.Commit();
  const EdgesReader reader(folder_ / "edges.h5");
  std::vector<EdgeMaps> read(maps.size());
  ParallelFor(static_cast<int>(read.size()), 4, [&](int i) { read[i] = reader.Read(i); });
  for (size_t i = 0; i < maps.size(); ++i) ExpectSame(read[i], maps[i]);
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

TEST_F(EdgesFileTest, DamagedDataIsRefused) {
  const EdgeMaps maps = MapsOfRandomRectangles();
  std::string bytes = FileBytes(Write("edges.h5", maps));
  // The deflated streams begin with 78 01 (zlib, fastest) or, by ISA-L from 2.31 on, 78 5e; spoil
  // the checksum's neighbourhood.
  const size_t stream = std::min(bytes.find("\x78\x01"), bytes.find("\x78\x5e"));
  ASSERT_NE(stream, bytes.npos);
  for (size_t i = stream + 2; i < stream + 12; ++i) bytes[i] = static_cast<char>(~bytes[i]);
  WriteBytes(folder_ / "damaged.h5", bytes);
  ExpectError<InputError>([&] { EdgesReader(folder_ / "damaged.h5").Read(12); },
                          {"damaged.h5", "/frames/000012", "damaged"});
}

TEST_F(EdgesFileTest, OtherKindsAndNewerVersionsAreRefused) {
  ExpectBadTexts({{R"({"kind": "symmetry", "schema_version": [1, 0]})", {"symmetry", "edges"}},
                  {R"({"kind": "edges", "schema_version": [1, 8]})", {"[1, 8]", "[1, 7]"}},
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

}  // namespace
}  // namespace soslam
