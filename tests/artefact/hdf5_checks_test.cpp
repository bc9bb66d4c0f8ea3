// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <thread>

#include "soslam/artefact/hdf5_artefact.h"
#include "soslam/artefact/hdf5_types.h"
#include "soslam/base/error.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

// Files that Hdf5File does not write, made with the library itself.
class Hdf5ChecksTest : public FolderTest {
 protected:
  Hdf5ChecksTest() { file_ = H5Fcreate(path_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT); }
  // A data set of float64 in which nothing is written.
  Hdf5Handle CreateDataSet(const ArrayShape& shape, hid_t creation,
                           const std::string& name = "/values") const {
    const std::vector<hsize_t> sizes(shape.begin(), shape.end());
    const Hdf5Handle space{H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr),
                           &H5Sclose};
    Hdf5Handle data_set{H5Dcreate2(file_, name.c_str(), H5T_IEEE_F64LE, space.id(), H5P_DEFAULT,
                                   creation, H5P_DEFAULT),
                        &H5Dclose};
    EXPECT_TRUE(data_set.valid());
    return data_set;
  }
  // The bytes that the library stores for so many numbers.
  std::string Packed(hsize_t count) const {
    const Hdf5Handle data_set = CreateDataSet({count}, Hdf5DataSetCreation({count}).id(),
                                              "/packed_" + std::to_string(count));
    WriteValues(data_set, std::vector<double>(count, 1.0 / 3.0));
    H5Fflush(file_, H5F_SCOPE_LOCAL);
    return ReadChunk(data_set, {count}, 1000).value();
  }
  static void SetChunk(hid_t creation, hsize_t size, const std::vector<H5Z_filter_t>& filters) {
    H5Pset_chunk(creation, 1, &size);
    for (const H5Z_filter_t filter : filters) {
      filter == H5Z_FILTER_DEFLATE ? H5Pset_deflate(creation, 9) : H5Pset_shuffle(creation);
    }
  }
  static void WriteChunk(const Hdf5Handle& data_set, const std::string& bytes) {
    const hsize_t begin = 0;
    H5Dwrite_chunk(data_set.id(), H5P_DEFAULT, 0, &begin, bytes.size(), bytes.data());
  }
  static void WriteValues(const Hdf5Handle& data_set, const std::vector<double>& values) {
    ASSERT_GE(
        H5Dwrite(data_set.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
        0);
  }
  void ExpectRefused(const std::vector<std::string>& words) {
    H5Fclose(file_);
    ExpectError<InputError>([&] { Hdf5File::Open(path_).ReadVector<double>("/values"); }, words);
    ExpectError<InputError>([&] { Hdf5File::Open(path_).ReadNumbers("/values"); }, words);
  }

  std::filesystem::path path_ = folder_ / "bad.h5";
  hid_t file_ = -1;
};

TEST_F(Hdf5ChecksTest, SizeWithoutValues) {
  const ArrayShape shape = {100'000'000};
  WriteChunk(CreateDataSet(shape, Hdf5DataSetCreation(shape).id()), Packed(100));
  ExpectRefused({"bad.h5", "/values", "has fewer bytes than its size needs"});
}

TEST_F(Hdf5ChecksTest, SizeBeyondMemory) {
  CreateDataSet({std::uint64_t{1} << 40, std::uint64_t{1} << 40}, H5P_DEFAULT);
  ExpectRefused({"bad.h5", "/values", "at most"});
}

// Values elsewhere, in several chunks, or packed otherwise: twice, five kilobytes would fill a
// gigabyte.
TEST_F(Hdf5ChecksTest, OtherStorage) {
  WriteBytes(folder_ / "secret", std::string(16, 'x'));
  const std::vector<std::function<void(hid_t)>> storages = {
      [](hid_t) {},
      [&](hid_t creation) { H5Pset_external(creation, (folder_ / "secret").c_str(), 0, 16); },
      [&](hid_t creation) {
        SetChunk(creation, 1, {H5Z_FILTER_SHUFFLE, H5Z_FILTER_DEFLATE});
      },
      [&](hid_t creation) {
        SetChunk(creation, 2, {H5Z_FILTER_DEFLATE, H5Z_FILTER_SHUFFLE});
      },
      [&](hid_t creation) {
        SetChunk(creation, 2, {H5Z_FILTER_DEFLATE, H5Z_FILTER_DEFLATE});
      }};
  for (size_t i = 0; i < storages.size(); ++i) {
    SCOPED_TRACE(i);
    const std::string name = "/values_" + std::to_string(i);
    const Hdf5Handle creation{H5Pcreate(H5P_DATASET_CREATE), &H5Pclose};
    storages[i](creation.id());
    WriteValues(CreateDataSet({2}, creation.id(), name), {1.0, 2.0});
    H5Fflush(file_, H5F_SCOPE_LOCAL);
    ExpectError<InputError>([&] { Hdf5File::Open(path_).ReadVector<double>(name); },
                            {"bad.h5", name, "one chunk, shuffled and deflated"});
  }
  H5Fclose(file_);
}

// The library's own links of this kind are gone once a file was opened, so that a test can only
// write one of a kind of its own by the same number.
hid_t FollowLink(const char*, hid_t group, const void*, size_t, hid_t, hid_t) {
  return H5Dopen2(group, "/target", H5P_DEFAULT);
}

TEST_F(Hdf5ChecksTest, LinkToAnotherFile) {
  const H5L_class_t links = {
      H5L_LINK_CLASS_T_VERS, H5L_TYPE_EXTERNAL, "",     nullptr, nullptr, nullptr,
      &FollowLink,           nullptr,           nullptr};
  H5Lregister(&links);
  CreateDataSet({0}, H5P_DEFAULT, "/target");
  ASSERT_GE(H5Lcreate_ud(file_, "/values", H5L_TYPE_EXTERNAL, "", 1, H5P_DEFAULT, H5P_DEFAULT), 0);
  ExpectRefused({"bad.h5", "/values"});
}

TEST_F(Hdf5ChecksTest, GroupThatHoldsItself) {
  const Hdf5Handle group{H5Gcreate2(file_, "/a", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), &H5Gclose};
  H5Lcreate_hard(file_, "/a", file_, "/a/again", H5P_DEFAULT, H5P_DEFAULT);
  H5Fclose(file_);
  ExpectError<InputError>([&] { Hdf5File::Open(path_).RequireWalkable(); },
                          {"bad.h5", "in each other"});
}

TEST_F(Hdf5ChecksTest, DamagedPackingIsRefused) {
  const std::string whole = Packed(100);
  const std::map<std::string, std::string> chunks = {{"/cut", whole.substr(0, whole.size() - 3)},
                                                     {"/of_fewer", Packed(99)},
                                                     {"/of_more", Packed(101)},
                                                     {"/of_nothing_known", std::string(20, 'x')}};
  for (const auto& [name, chunk] : chunks) {
    WriteChunk(CreateDataSet({100}, Hdf5DataSetCreation({100}).id(), name), chunk);
  }
  H5Fclose(file_);
  for (const auto& chunk : chunks) {
    ExpectError<InputError>([&] { Hdf5File::Open(path_).ReadVector<double>(chunk.first); },
                            {"bad.h5", chunk.first, "damaged"});
  }
}

// The library tells its errors to each thread for itself.
TEST_F(Hdf5ChecksTest, AnyThreadFailsWithoutTextOfTheLibrary) {
  const Hdf5Handle group{H5Gcreate2(file_, "/values", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                         &H5Gclose};
  H5Fclose(file_);
  const Hdf5File file = Hdf5File::Open(path_);
  testing::internal::CaptureStderr();
  std::thread([&] { EXPECT_THROW(file.ReadVector<double>("/values"), InputError); }).join();
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(Hdf5ChecksTest, NestedHeader) {
  H5Fclose(file_);
  Hdf5File file = Hdf5File::Create(path_);
  file.WriteText("/", kHeaderAttribute, std::string(100'000, '['));
  file.Close();
  ExpectError<InputError>([&] { OpenArtefact(path_, "edges"); }, {"bad.h5", "more than 100"});
}

}  // namespace
}  // namespace soslam
