// What `prt-inspect --plots` writes: pictures and tables of a compressed model.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/report.h"
#include "image/image.h"

namespace prt::inspect {

struct Plot {
  std::string name;    ///< of the files, without extension
  image::Image image;  ///< linear, as image::write_image takes it
  std::string csv;     ///< the data
};

/// What a file alone tells: `clusters` and `superclusters`, coloured, and their sizes;
/// `vector-variance`, if there are vectors, what each adds; of adaptive encodings `vectors`, how
/// many each cluster has. Throws Error (bad_input) when the model holds no compressed transfer.
std::vector<Plot> plots_of_model(const std::filesystem::path& model);

/// Names of the plots that need the transfer as well.
inline const std::vector<std::string> kPlotsOfTransfer{
    "error-histogram",        "error",           "error-over-storage",
    "error-over-components",  "clusters-before", "clusters-reclassified",
    "clusters-superclustered"};

/// The transfer that lies beside a model as prt-transfer and Makefile.assets leave it, NAME.prt.glb
/// or NAME.glb and NAME.transfer.exr; empty if there is none.
std::filesystem::path transfer_beside(const std::filesystem::path& model);

/// Tells which that is, or what is left out without it.
void tell_transfer_beside(const std::filesystem::path& model);

/// What the transfer that it was compressed from adds: `error-histogram`, and beside the model's
/// what other encodings of that signal would give: `error`, by method, `error-over-storage`,
/// `error-over-components`, and clusters as an iterative encoder leaves them (`clusters-before`)
/// and after coherence optimisation (`clusters-reclassified`, `clusters-superclustered`), with as
/// many clusters and (on average) vectors as the model has.
std::vector<Plot> plots_of_compression(const std::filesystem::path& model,
                                       const std::filesystem::path& transfer);

/// Writes NAME.png and NAME.csv of each plot into the folder, made when missing, and adds
/// them to the report's outputs. Throws Error (failed).
void write_plots(const std::vector<Plot>& plots, const std::filesystem::path& folder,
                 bool no_clobber, Report& report);

/// Names of all plots that the two can give, and the files of them in a folder;
/// none of a folder that is yet to be made.
std::vector<std::string> plot_names(bool with_transfer);
std::vector<std::filesystem::path> plot_files(const std::filesystem::path& folder,
                                              bool with_transfer);

}  // namespace prt::inspect
