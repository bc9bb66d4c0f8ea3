// SPDX-License-Identifier: BSD-3-Clause
#include "stage/run_pages.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <vector>

#include "artefact/atomic_file.h"
#include "base/error.h"
#include "dataset/image_path.h"
#include "report/page.h"
#include "stage/frame_images.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

// Folders of datasets; those of other people's runs and tables beside them have no variants.
std::vector<fs::path> DatasetsOf(const fs::path& results) {
  std::vector<fs::path> folders;
  for (const auto& entry : fs::directory_iterator(results)) {
    if (entry.is_directory() && fs::exists(entry.path() / "plan.mk")) {
      folders.push_back(entry.path());
    }
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

// Where the dataset was when the plan was made: the first line of its list of files.
fs::path DatasetOf(const fs::path& results_of_dataset) {
  std::ifstream list(results_of_dataset / "shared" / "dataset.txt");
  std::string folder;
  std::getline(list, folder);
  return folder;
}

// Frames whose image is not there have none on the page.
ImageSource ImagesIn(const fs::path& dataset, const Sequence& sequence) {
  const auto reader = std::make_shared<const FrameImageReader>(sequence);
  return [dataset, reader, &sequence](int frame_index) -> std::optional<cv::Mat> {
    const Frame& frame = sequence.frames[static_cast<size_t>(frame_index)];
    if (frame.image.empty()) return std::nullopt;
    const FrameImage image{&frame,
                           ImagePath(dataset, frame.image, fmt::format("frame {}", frame.id))};
    if (!fs::exists(image.path)) return std::nullopt;
    return reader->ReadColour(image);
  };
}

}  // namespace

void RunPages(const PagesOptions& /*options*/, const StageFiles& files, int threads) {
  const fs::path& results = files.at("results");
  if (!fs::is_directory(results)) {
    throw InputError(results.string() + ": is no folder; expected results of runs");
  }
  std::vector<nlohmann::json> pages;
  for (const fs::path& folder : DatasetsOf(results)) {
    const fs::path dataset = DatasetOf(folder);
    nlohmann::json data = PageData(
        folder, [&](const Sequence& sequence) { return ImagesIn(dataset, sequence); }, threads);
    const std::string html = PageHtml(data.at("dataset"), "showDataset", data);
    WriteTextFile(folder / "report.html", html);
    fmt::print("{}: {} variants, {} images, {:.1f} MB\n", (folder / "report.html").string(),
               data["variants"].size(), data["images"].size(),
               static_cast<double>(html.size()) / 1e6);
    data.erase("images");
    pages.push_back(std::move(data));
  }
  if (pages.empty()) {
    throw NothingUsableError(results.string() +
                             ": no <dataset>/plan.mk; expected at least one run");
  }
  WriteTextFile(results / "report.html", PageHtml("Results", "showOverview", OverviewData(pages)));
}

}  // namespace soslam
