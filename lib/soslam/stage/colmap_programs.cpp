// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/stage/colmap_programs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <opencv2/imgcodecs.hpp>
#include <regex>
#include <sstream>

#include "soslam/artefact/atomic_file.h"
#include "soslam/base/error.h"
#include "soslam/base/paths.h"
#include "soslam/base/progress.h"
#include "soslam/dataset/colmap_model.h"
#include "soslam/image/box_mask.h"
#include "soslam/image/image_format.h"
#include "soslam/system/hash.h"
#include "soslam/system/process.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

// Files in a workspace.
constexpr const char* kImageList = "images.txt";
constexpr const char* kLog = "log.txt";
constexpr const char* kMasks = "masks";
constexpr const char* kModels = "sparse";

constexpr int kBlockSize = 10;  // images per block of exhaustive matching

// Observations of a point with a larger error are left out. With COLMAP's own bound, 4, enough
// wrong matches remain to bend an estimated focal length by more than 1 %.
constexpr const char* kMaxReprojectionErrorPx = "1.5";

// Least contrast of faint features (difference of Gaussians); a third of COLMAP's own
// bound, a guess.
constexpr const char* kFaintPeak = "0.0022";

// Last number in a line; 0 without one.
int LastNumber(const std::string& line) {
  const size_t end = line.find_last_of("0123456789");
  if (end == line.npos) return 0;
  const size_t before = line.find_last_not_of("0123456789", end);
  const size_t begin = before == line.npos ? 0 : before + 1;
  return std::atoi(line.substr(begin, std::min<size_t>(end + 1 - begin, 9)).c_str());
}

bool Contains(const std::string& line, const char* text) { return line.find(text) != line.npos; }

// Text that differs for each job that COLMAP may treat differently.
std::string MakeStamp(const ColmapJob& job, const std::string& version) {
  std::string text = fmt::format("COLMAP {}\nexhaustive {}\nfixed camera {}\n", version,
                                 job.exhaustive, job.camera_is_fixed);
  if (!job.camera_is_fixed) text += fmt::format("at most {} px\n", kMaxReprojectionErrorPx);
  if (job.poses.empty()) text += fmt::format("or features down to {}\n", kFaintPeak);
  if (job.camera) {
    const ColmapCameraText camera = ToColmap(*job.camera);
    text += fmt::format("{} {}\n", camera.model, camera.parameters);
  }
  for (size_t i = 0; i < job.images.size(); ++i) {
    text += fmt::format("{} {}\n", Sha256OfFile(job.dataset / job.images[i]), job.images[i]);
    if (!job.masked.empty()) {
      for (const Box& box : job.masked[i]) {
        text += fmt::format("  without {} {} {} {}\n", box.x_min, box.y_min, box.x_max, box.y_max);
      }
    }
    if (job.poses.empty() || !job.poses[i]) continue;
    text += fmt::format("  {} {}\n", fmt::join(job.poses[i]->translation, " "),
                        fmt::join(job.poses[i]->rotation.coeffs(), " "));
  }
  return text;
}

// Progress of a program by the lines that it prints.
class Follower {
 public:
  Follower(const std::string& what, int count) : progress_(what, count), count_(count) {}
  void Reach(int done) {
    for (; done_ < std::min(done, count_); ++done_) progress_.Step();
  }
  void Step() { Reach(done_ + 1); }

 private:
  Progress progress_;
  int count_;
  int done_ = 0;
};

// The model of the given poses, in which COLMAP triangulates points.
void WriteGivenModel(const ColmapJob& job, const fs::path& folder) {
  fs::create_directories(folder);
  const ColmapCameraText camera = ToColmap(*job.camera);
  std::string parameters = camera.parameters, images;
  std::ranges::replace(parameters, ',', ' ');
  for (size_t i = 0; i < job.images.size(); ++i) {
    if (!job.poses[i]) continue;
    const Rigid3d camera_from_world = job.poses[i]->Inverse();
    const Eigen::Quaterniond& q = camera_from_world.rotation;
    images += fmt::format("{} {} {} {} {} {} 1 {}\n\n", i + 1, q.w(), q.x(), q.y(), q.z(),
                          fmt::join(camera_from_world.translation, " "), job.images[i]);
  }
  WriteTextFile(folder / "cameras.txt",
                fmt::format("1 {} {} {} {}\n", camera.model, job.camera->camera.width,
                            job.camera->camera.height, parameters));
  WriteTextFile(folder / "images.txt", images);
  WriteTextFile(folder / "points3D.txt", "");
}

// The installed version.
struct Installation {
  std::string version;
  std::string extraction = "SiftExtraction";  // prefixes of options, which have changed in 3.13
  std::string matching = "SiftMatching";
};

Installation FindColmap() {
  setenv("QT_QPA_PLATFORM", "offscreen", 0);  // its programs open a display otherwise
  Installation colmap;
  const auto found = FollowProgram({"colmap", "-h"}, [&](const std::string& line) {
    std::smatch match;
    if (colmap.version.empty() && std::regex_search(line, match, std::regex(R"(COLMAP (\d\S*))"))) {
      colmap.version = match[1];
    }
  });
  if (!found) {
    throw SettingsError(
        "colmap: there is no such program on PATH; expected COLMAP: install the package colmap "
        "(apt-get install colmap), or give a finished model of it (--model FOLDER)");
  }
  FollowProgram({"colmap", "feature_extractor", "-h"}, [&](const std::string& line) {
    if (!Contains(line, "--FeatureExtraction.use_gpu")) return;
    colmap.extraction = "FeatureExtraction";
    colmap.matching = "FeatureMatching";
  });
  return colmap;
}

// COLMAP's programs on a job, one after the other, with a common log.
class Programs {
 public:
  Programs(const ColmapJob& job, const fs::path& workspace, const Installation& colmap)
      : job_(job), workspace_(workspace), colmap_(colmap), log_(workspace / kLog) {}

  // Where not all images find a place in one model, once more with fainter features, which small or
  // smooth images have. The run whose largest model has more images is kept; what fails in the
  // second one costs nothing.
  void MakeModels() {
    const fs::path usual = workspace_ / "sparse.usual", faint = workspace_ / "sparse.faint";
    const bool may_be_faint = job_.poses.empty();
    int by_usual = 0, by_faint = 0;
    try {
      by_usual = Place(usual);
    } catch (const NothingUsableError&) {
      if (!may_be_faint || !has_no_features_) throw;
    }
    if (by_usual < CountOfImages() && may_be_faint) {
      with_faint_features_ = true;
      try {
        by_faint = Place(faint);
      } catch (const NothingUsableError&) {
        if (by_usual == 0) throw;
        log_ << "with fainter features: " << error_ << ' ' << last_line_ << std::endl;
      }
    }
    if (by_usual == 0 && by_faint == 0) {
      throw NumericalError(fmt::format(
          "{}: COLMAP found no two images to begin a model with; expected images that overlap, "
          "from places apart: where the camera only turns there is no baseline, and poses have to "
          "be given (--poses given); see {}",
          job_.dataset.string(), LogPath()));
    }
    fs::rename(by_faint > by_usual ? faint : usual, workspace_ / kModels);
    fs::remove_all(by_faint > by_usual ? usual : faint);
  }

 private:
  // Features, matches, and models in the folder `models`. Returns the number of images in the
  // largest one.
  int Place(const fs::path& models) {
    fs::remove_all(models);
    fs::create_directories(models);
    Extract();
    Match();
    Map(models);
    int placed = 0;
    for (const fs::path& model : ColmapModelsIn(models)) {
      // The model may still be moved: its files are not inputs yet.
      std::uint64_t count = 0;
      if (std::ifstream binary(model / "images.bin", std::ios::binary); binary) {
        binary.read(reinterpret_cast<char*>(&count), sizeof(count));
      } else {
        std::ifstream text(model / "images.txt");
        for (std::string line; std::getline(text, line);) count += line.starts_with('#') ? 0 : 1;
        count /= 2;  // lines of an image
      }
      placed = std::max(placed, static_cast<int>(count));
    }
    return placed;
  }

  using Options = std::vector<std::pair<std::string, std::string>>;  // names and values
  using UseLine = std::function<void(const std::string&)>;

  std::string LogPath() const { return (workspace_ / kLog).string(); }
  std::string DatabasePath() const {
    return (workspace_ / (with_faint_features_ ? "database_faint.db" : "database.db")).string();
  }
  int CountOfImages() const { return static_cast<int>(job_.images.size()); }

  // Returns the exit code. `use_line` gets each line that the program prints.
  int Call(const std::string& program, const Options& options, const UseLine& use_line) {
    std::vector<std::string> words = {"colmap", program};
    for (const auto& [name, value] : options) words.insert(words.end(), {name, value});
    log_ << fmt::format("$ {}\n", fmt::join(words, " ")) << std::flush;
    return FollowProgram(words,
                         [&](const std::string& line) {
                           log_ << line << '\n' << std::flush;
                           const bool is_error =
                               Contains(line, "ERROR") || Contains(line, "Check failed");
                           if (is_error) error_ = line;
                           if (line.find_first_not_of(" \r") != line.npos) last_line_ = line;
                           use_line(line);
                         })
        .value_or(-1);
  }

  // Throws NothingUsableError unless the exit code is 0 or an `allowed` one.
  void Require(const std::string& program, int exit_code, int allowed = 0) const {
    if (exit_code == 0 || exit_code == allowed) return;
    throw NothingUsableError(fmt::format("colmap {}: failed with exit code {}: {}; see {}", program,
                                         exit_code, error_.empty() ? last_line_ : error_,
                                         LogPath()));
  }

  // Throws NothingUsableError when features were counted, and no image has one.
  void Extract() {
    const std::string camera_model = job_.camera ? ToColmap(*job_.camera).model : "SIMPLE_RADIAL";
    Options options = {
        {"--database_path", DatabasePath()},
        {"--image_path", job_.dataset.string()},
        {"--image_list_path", (workspace_ / kImageList).string()},
        {"--ImageReader.single_camera", "1"},
        {fmt::format("--{}.use_gpu", colmap_.extraction), "0"},
        {fmt::format("--{}.num_threads", colmap_.extraction), std::to_string(job_.threads)},
        {"--ImageReader.camera_model", camera_model}};
    if (job_.camera) {
      options.emplace_back("--ImageReader.camera_params", ToColmap(*job_.camera).parameters);
    }
    if (with_faint_features_) {
      options.emplace_back("--SiftExtraction.peak_threshold", kFaintPeak);
    }
    if (!job_.masked.empty()) {
      // COLMAP reads masks as <name of the image>.png.
      for (size_t i = 0; i < job_.masked.size(); ++i) {
        if (job_.masked[i].empty()) continue;
        const ImageSize size = ReadImageHeader(job_.dataset / job_.images[i]).value().stored;
        const fs::path mask = workspace_ / kMasks / (job_.images[i] + ".png");
        fs::create_directories(mask.parent_path());
        const cv::Size pixels(static_cast<int>(size.width), static_cast<int>(size.height));
        if (!cv::imwrite(mask.string(), MaskOutBoxes(job_.masked[i], pixels))) {
          throw SettingsError(fmt::format("{}: cannot be written", mask.string()));
        }
      }
      options.emplace_back("--ImageReader.mask_path", (workspace_ / kMasks).string());
    }
    Follower follower("images: features", CountOfImages());
    int counted = 0, with_features = 0;
    const int exit_code = Call("feature_extractor", options, [&](const std::string& line) {
      if (Contains(line, "Processed file [")) follower.Step();
      if (Contains(line, "already extracted")) ++with_features;
      if (!Contains(line, "Features:")) return;
      ++counted;
      if (LastNumber(line) > 0) ++with_features;
    });
    Require("feature_extractor", exit_code);
    has_no_features_ = counted > 0 && with_features == 0;
    if (!has_no_features_) return;
    throw NothingUsableError(fmt::format(
        "{}: none of {} images has features; expected corners and texture: are the images blank, "
        "dark or blurred?",
        job_.dataset.string(), job_.images.size()));
  }

  void Match() {
    Options options = {
        {"--database_path", DatabasePath()},
        {fmt::format("--{}.use_gpu", colmap_.matching), "0"},
        {fmt::format("--{}.num_threads", colmap_.matching), std::to_string(job_.threads)}};
    if (with_faint_features_) {
      options.emplace_back(fmt::format("--{}.guided_matching", colmap_.matching), "1");
    }
    const char* program = "sequential_matcher";
    const char* what = "images matched";
    int count = CountOfImages();
    if (job_.exhaustive) {
      options.emplace_back("--ExhaustiveMatching.block_size", std::to_string(kBlockSize));
      program = "exhaustive_matcher";
      what = "blocks of images matched";
      const int blocks = (count + kBlockSize - 1) / kBlockSize;
      count = blocks * blocks;
    }
    Follower follower(what, count);
    const int exit_code = Call(program, options, [&](const std::string& line) {
      if (Contains(line, "block [") || Contains(line, "image [")) follower.Step();
    });
    Require(program, exit_code);
  }

  // Throws NothingUsableError for a crash; the mapper also fails where it finds no model.
  void Map(const fs::path& output) {
    const bool poses_are_given = !job_.poses.empty();
    const fs::path given = workspace_ / "given";
    Options options = {{"--database_path", DatabasePath()},
                       {"--image_path", job_.dataset.string()},
                       {"--output_path", output.string()},
                       {"--Mapper.num_threads", std::to_string(job_.threads)}};
    if (poses_are_given) {
      WriteGivenModel(job_, given);
      options.insert(options.end(), {{"--input_path", given.string()}, {"--clear_points", "1"}});
    }
    if (job_.camera_is_fixed) {
      // Images whose camera has a larger coefficient of distortion would be left out.
      options.emplace_back("--Mapper.max_extra_param", "1e6");
      for (const char* part : {"focal_length", "principal_point", "extra_params"}) {
        options.emplace_back(fmt::format("--Mapper.ba_refine_{}", part), "0");
      }
    } else {
      options.emplace_back("--Mapper.filter_max_reproj_error", kMaxReprojectionErrorPx);
    }
    const char* program = poses_are_given ? "point_triangulator" : "mapper";
    Follower follower("images registered", CountOfImages());
    const int exit_code = Call(program, options, [&](const std::string& line) {
      if (Contains(line, "Registering image #")) follower.Reach(LastNumber(line));
      if (Contains(line, "Triangulating image #")) follower.Step();
    });
    if (exit_code != 0 && poses_are_given) {
      throw NothingUsableError(fmt::format(
          "{}: colmap point_triangulator failed with exit code {}, as where no point is "
          "triangulated; expected poses and a camera that fit the images; see {}",
          job_.dataset.string(), exit_code, LogPath()));
    }
    constexpr int kFoundNothing = 1;
    Require(program, exit_code, kFoundNothing);
  }

  const ColmapJob& job_;
  const fs::path& workspace_;
  const Installation& colmap_;
  std::ofstream log_;
  bool with_faint_features_ = false, has_no_features_ = false;
  std::string last_line_, error_;
};

}  // namespace

std::vector<fs::path> ColmapModelsIn(const fs::path& folder) {
  if (IsColmapModel(folder)) return {folder};
  std::vector<fs::path> models;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (IsColmapModel(entry.path())) models.push_back(entry.path());
  }
  std::ranges::sort(models, {}, [](const fs::path& model) {
    const std::string name = model.filename().string();
    return std::pair(name.size(), name);
  });
  return models;
}

std::vector<fs::path> RunColmap(const ColmapJob& job, const fs::path& workspace,
                                std::string* version) {
  const Installation colmap = FindColmap();
  *version = colmap.version;
  const fs::path stamp = workspace / "job.txt";
  const std::string wanted = MakeStamp(job, colmap.version);
  std::ostringstream text;
  text << std::ifstream(stamp, std::ios::binary).rdbuf();
  const std::string found = text.str();
  if (found != wanted) {
    if (IsFolder(workspace) && !fs::is_empty(workspace) && !found.starts_with("COLMAP ")) {
      throw SettingsError(workspace.string() +
                          ": has files that are not of soslam-reconstruct, which would be removed; "
                          "expected another --output, or --model with a model of this folder");
    }
    fs::remove_all(workspace);
    fs::create_directories(workspace);
    WriteTextFile(workspace / kImageList, fmt::format("{}\n", fmt::join(job.images, "\n")));
    WriteTextFile(stamp, wanted);
  }
  if (!IsFolder(workspace / kModels)) Programs(job, workspace, colmap).MakeModels();
  return ColmapModelsIn(workspace / kModels);
}

}  // namespace soslam
