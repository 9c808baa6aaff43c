#include "inspect/plots.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/log.h"
#include "core/stopwatch.h"
#include "cpca/overdraw.h"
#include "cpca/superclusters.h"
#include "gltf/document.h"
#include "image/false_color.h"
#include "inspect/compression_error.h"
#include "inspect/encoding_study.h"
#include "inspect/histogram.h"
#include "inspect/line_plot.h"
#include "inspect/mesh_picture.h"
#include "inspect/statistics.h"
#include "sh/basis.h"
#include "sh/radiance_metric.h"

namespace prt::inspect {

namespace {

constexpr int kMostComponents = 12;  // of the comparison of methods

using Labels = std::vector<std::uint32_t>;

struct CompressedModel {
  mesh::Scene scene;
  gltf::PrecomputedTransfer transfer;
};

CompressedModel load(const std::filesystem::path& path) {
  const gltf::Document document = gltf::Document::load(path);
  auto transfer = document.precomputed_transfer();
  if (!transfer) {
    throw_bad_input("holds no compressed transfer to plot",
                    {.file = path.string(), .advice = "Run prt-compress on it."});
  }
  return {document.scene(), std::move(*transfer)};
}

std::string sizes_csv(const Labels& labels) {
  std::vector<std::size_t> sizes(
      labels.empty() ? 0 : *std::max_element(labels.begin(), labels.end()) + 1);
  for (const std::uint32_t label : labels) ++sizes[label];
  std::string csv = "label,vertices\n";
  for (std::size_t i = 0; i < sizes.size(); ++i) csv += fmt::format("{},{}\n", i, sizes[i]);
  return csv;
}

// A colour for each cluster or supercluster, and how often triangles are sent when drawn by them.
Plot label_plot(const std::string& name, const mesh::Scene& scene, const Labels& labels) {
  std::vector<Vec3> colors;
  for (const std::uint32_t label : labels) colors.push_back(image::cluster_color(label));
  const double overdraw =
      cpca::overdraw(cpca::sent_triangle_count(scene.indices(), labels), scene.triangle_count());
  return {name, draw_scene(scene, colors, fmt::format("{}: overdraw {:.3f}", name, overdraw)),
          sizes_csv(labels)};
}

// How many vectors the cluster of a vertex has, red for the most.
Plot vector_count_plot(const mesh::Scene& scene, const cpca::Encoding& encoding) {
  std::vector<Vec3> colors;
  for (const std::uint32_t k : encoding.cluster_of_point) {
    colors.push_back(image::heat_color(static_cast<float>(encoding.component_counts[k]) /
                                       static_cast<float>(std::max(encoding.component_count, 1))));
  }
  std::string csv = "cluster,vectors\n";
  for (std::size_t k = 0; k < encoding.component_counts.size(); ++k) {
    csv += fmt::format("{},{}\n", k, encoding.component_counts[k]);
  }
  const std::string caption =
      fmt::format("vectors of a vertex's cluster: 0 (blue) to {} (red)", encoding.component_count);
  return {"vectors", draw_scene(scene, colors, caption), csv};
}

// What each vector adds to the signal beyond the means: as long as it still falls, more are of use.
Plot variance_plot(const cpca::Encoding& encoding) {
  const auto most = static_cast<std::size_t>(encoding.component_count);
  const auto cluster_count = static_cast<std::size_t>(encoding.cluster_count);
  std::vector<double> sums(cluster_count * most), squares(sums.size()), sizes(cluster_count);
  for (std::size_t p = 0; p < encoding.point_count; ++p) {
    const std::size_t k = encoding.cluster_of_point[p];
    sizes[k] += 1.0;
    for (std::size_t i = 0; i < most; ++i) {
      const double weight = encoding.weights[p * most + i];
      sums[k * most + i] += weight;
      squares[k * most + i] += weight * weight;
    }
  }
  Series series{"all clusters", {}, {}};
  for (std::size_t i = 0; i < most; ++i) {
    double variance = 0.0;
    for (std::size_t k = 0; k < cluster_count; ++k) {
      if (sizes[k] == 0.0) continue;
      double length = 0.0;  // normalised weights have their scale in the vector
      for (const float value : encoding.basis(static_cast<int>(k), static_cast<int>(i))) {
        length += double{value} * double{value};
      }
      const double sum = sums[k * most + i];
      variance += length * std::max(0.0, squares[k * most + i] - sum * sum / sizes[k]);
    }
    series.x.push_back(static_cast<double>(i + 1));
    series.y.push_back(variance);
  }
  const LinePlot plot{.title = "What each vector of the clusters adds",
                      .x_label = "vector",
                      .y_label = "squares of its weights about their mean",
                      .series = {series}};
  return {"vector-variance", draw(plot), to_csv(plot)};
}

std::filesystem::path name_beside(const std::filesystem::path& model) {
  std::filesystem::path name = model.filename().replace_extension();
  if (name.extension() == ".prt") name.replace_extension();
  return name += ".transfer.exr";
}

/// n' of an adaptive encoding: the average over points.
int average_component_count(const cpca::Encoding& encoding) {
  double sum = 0.0;
  for (const std::uint32_t k : encoding.cluster_of_point) {
    sum += encoding.component_count_of(static_cast<int>(k));
  }
  return static_cast<int>(std::lround(sum / static_cast<double>(encoding.point_count)));
}

/// Tells how long the encodings of plots take: beforehand as a multiple of the first of them, then
/// by what is done.
class TimeLeft {
 public:
  explicit TimeLeft(const StudyWork& work)
      : left_(work.iterative + work.methods + work.storage + work.components) {
    log::info(
        "encoding the transfer anew for plots, which takes about {:.0f} times as long as "
        "prt-compress --method iterative",
        left_ / work.iterative);
  }

  void pass(double work) {
    done_ += work;
    left_ -= work;
    const double seconds = stopwatch_.seconds() * left_ / done_;
    if (seconds >= kNoticed) log::info("plots: about {:.0f} s left", seconds);
  }

 private:
  static constexpr double kNoticed = 2.0;  // seconds

  const Stopwatch stopwatch_;
  double done_ = 0.0, left_;
};

// The file beside what each method makes of the same counts.
Plot error_plot(const mesh::Scene& scene, const signal::TransferSignal& signal,
                const EncodingError& stored, const cpca::Encoding& iterative) {
  std::vector<EncodingError> errors = errors_by_method(signal, iterative);
  errors.insert(errors.begin(), stored);
  const std::string title = fmt::format("Error over the surface: {} clusters of {} vectors",
                                        iterative.cluster_count, iterative.component_count);
  return {"error", draw(scene, errors, title), to_csv(errors)};
}

}  // namespace

std::vector<Plot> plots_of_model(const std::filesystem::path& path) {
  const CompressedModel model = load(path);
  const cpca::Encoding& encoding = model.transfer.encoding;
  const Labels superclusters =
      model.transfer.first_clusters.empty()
          ? encoding.cluster_of_point
          : cpca::superclusters_of_points(encoding, model.transfer.first_clusters);
  std::vector<Plot> plots;
  plots.push_back(label_plot("clusters", model.scene, encoding.cluster_of_point));
  plots.push_back(label_plot("superclusters", model.scene, superclusters));
  if (encoding.component_count > 0) plots.push_back(variance_plot(encoding));
  if (!encoding.component_counts.empty()) {
    plots.push_back(vector_count_plot(model.scene, encoding));
  }
  return plots;
}

std::filesystem::path transfer_beside(const std::filesystem::path& model) {
  const std::filesystem::path path = model.parent_path() / name_beside(model);
  std::error_code error;
  return std::filesystem::is_regular_file(path, error) ? path : std::filesystem::path();
}

void tell_transfer_beside(const std::filesystem::path& model) {
  const std::filesystem::path path = transfer_beside(model);
  if (!path.empty()) {
    log::info("taking {} for the transfer that {} was compressed from", path.string(),
              model.string());
    return;
  }
  log::warning("without --transfer, or {} beside the model, these plots are left out: {}",
               name_beside(model).string(), fmt::join(kPlotsOfTransfer, ", "));
}

std::vector<Plot> plots_of_compression(const std::filesystem::path& path,
                                       const std::filesystem::path& transfer_path) {
  const CompressedModel model = load(path);
  const CompressionError error = compression_error(path, transfer_path);
  signal::TransferSignal signal = signal::read_transfer(transfer_path);
  sh::RadianceMetric(signal.row_count, sh::row_size(signal.band_count)).apply(signal.values);
  const Histogram histogram = make_histogram(error.relative);
  std::vector<Plot> plots;
  plots.push_back({"error-histogram",
                   plot(histogram, "Compression error of " + path.filename().string(),
                        "error of a vertex / root mean square transfer"),
                   to_csv(histogram)});
  const int clusters = model.transfer.encoding.cluster_count,
            components = average_component_count(model.transfer.encoding),
            most = std::min(kMostComponents, signal.dimension());
  const StudyWork work = study_work(signal.vertex_count(), clusters, components, most);
  TimeLeft time(work);
  const cpca::Encoding iterative = encode_iteratively(signal, clusters, components);
  time.pass(work.iterative);
  const EncodingError stored{"this file", error.json["squared_error"], error.relative};
  plots.push_back(error_plot(model.scene, signal, stored, iterative));
  time.pass(work.methods);
  const LinePlot storage = error_over_storage(signal);
  plots.push_back({"error-over-storage", draw(storage), to_csv(storage)});
  time.pass(work.storage);
  const LinePlot methods = error_over_components(signal, clusters, most);
  plots.push_back({"error-over-components", draw(methods), to_csv(methods)});
  const CoherenceStudy study = study_coherence(signal, model.scene.indices(), iterative);
  plots.push_back(label_plot("clusters-before", model.scene, study.before));
  plots.push_back(label_plot("clusters-reclassified", model.scene, study.reclassified));
  plots.push_back(label_plot("clusters-superclustered", model.scene, study.superclustered));
  return plots;
}

void write_plots(const std::vector<Plot>& plots, const std::filesystem::path& folder,
                 bool no_clobber, Report& report) {
  std::filesystem::create_directory(folder);
  for (const Plot& plot : plots) {
    const std::filesystem::path png = folder / (plot.name + ".png");
    const std::filesystem::path csv = folder / (plot.name + ".csv");
    image::write_image(png, plot.image, no_clobber);
    AtomicFile file(csv, no_clobber);
    file.write(plot.csv);
    file.commit();
    report.add_output(png);
    report.add_output(csv);
  }
}

std::vector<std::string> plot_names(bool with_transfer) {
  std::vector<std::string> names{"clusters", "superclusters", "vector-variance", "vectors"};
  if (with_transfer) names.insert(names.end(), kPlotsOfTransfer.begin(), kPlotsOfTransfer.end());
  return names;
}

std::vector<std::filesystem::path> plot_files(const std::filesystem::path& folder,
                                              bool with_transfer) {
  std::vector<std::filesystem::path> files;
  if (!std::filesystem::exists(folder)) return files;
  for (const std::string& name : plot_names(with_transfer)) {
    files.push_back(folder / (name + ".png"));
    files.push_back(folder / (name + ".csv"));
  }
  return files;
}

}  // namespace prt::inspect
