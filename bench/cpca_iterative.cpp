// Iterative clustered PCA beside the plain way: each iteration one product of the signal with all
// clusters' vectors by BLAS, then covariance and the needed eigenpairs of every cluster by LAPACK.
//   bench_cpca_iterative [signal.npy [clusters [components [iterations [seed]]]]]
// Without a signal: 50,000 × 600 made up, 256 clusters, 8 components, 15 iterations. The plain way
// takes minutes. Processor time, of all threads, tells the ratio on busy machines too.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include "core/parallel.h"
#include "cpca/cluster_pca.h"
#include "cpca/clusters.h"
#include "cpca/encoder.h"
#include "cpca/figures.h"
#include "cpca/fit.h"
#include "cpca/seeding.h"
#include "linalg/product.h"
#include "made_signal.h"
#include "peak.h"
#include "signal/npy.h"

namespace {

using namespace prt;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double processor_seconds() {
  return static_cast<double>(std::clock()) / static_cast<double>(CLOCKS_PER_SEC);
}

class Plain {
 public:
  Plain(const signal::Matrix& signal, const cpca::Options& options)
      : signal_(signal.values),
        n_(signal.column_count),
        cluster_count_(static_cast<std::size_t>(options.cluster_count)),
        means_(cpca::seed_means(signal_, n_, cluster_count_, options.seed)),
        labels_(signal.row_count) {}

  double run(const cpca::Options& options) {
    for (int count = 0; count <= options.component_count; ++count) {
      if (count > 0) fit(static_cast<std::size_t>(count));
      for (int i = 0; i < options.iterations; ++i) {
        const auto start = std::chrono::steady_clock::now();
        classify(static_cast<std::size_t>(count));
        product_seconds_ += seconds_since(start);
        fit(static_cast<std::size_t>(count));
      }
    }
    classify(static_cast<std::size_t>(options.component_count));
    double error = 0.0;
    for (const double part : errors_) error += part;
    return error;
  }

  double product_seconds() const { return product_seconds_; }
  double fit_seconds() const { return fit_seconds_; }

 private:
  static constexpr std::size_t kBlock = 448;

  void classify(std::size_t count) {
    const std::size_t rows = cluster_count_ * (1 + count);
    std::vector<float> vectors;
    std::vector<double> offsets;  // ‖mean‖², then mean·b_i
    for (std::size_t k = 0; k < cluster_count_; ++k) {
      const float* mean = &means_[k * n_];
      vectors.insert(vectors.end(), mean, mean + n_);
      offsets.push_back(dot(mean, mean));
      for (std::size_t i = 0; i < count; ++i) {
        const float* basis = &bases_[(k * count + i) * n_];
        vectors.insert(vectors.end(), basis, basis + n_);
        offsets.push_back(dot(mean, basis));
      }
    }
    errors_.assign(block_count(labels_.size(), kBlock), 0.0);
    parallel_for(labels_.size(), kBlock, [&](std::size_t begin, std::size_t end) {
      std::vector<float> products((end - begin) * rows);
      linalg::gemm(1.0f, {&signal_[begin * n_], end - begin, n_}, linalg::Transpose::no,
                   {vectors.data(), rows, n_}, linalg::Transpose::yes, 0.0f,
                   {products.data(), end - begin, rows});
      for (std::size_t p = begin; p < end; ++p) {
        const double square = dot(&signal_[p * n_], &signal_[p * n_]);
        errors_[begin / kBlock] +=
            choose(&products[(p - begin) * rows], offsets, square, count, labels_[p]);
      }
    });
  }

  double choose(const float* products, const std::vector<double>& offsets, double square,
                std::size_t count, std::uint32_t& label) const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < cluster_count_; ++k) {
      const float* product = products + k * (1 + count);
      const double* offset = &offsets[k * (1 + count)];
      double error = square - 2.0 * double{product[0]} + offset[0];
      for (std::size_t i = 1; i <= count; ++i) {
        const double share = double{product[i]} - offset[i];
        error -= share * share;
      }
      if (error < least) least = error, label = static_cast<std::uint32_t>(k);
    }
    return std::max(0.0, least);
  }

  void fit(std::size_t count) {
    const auto start = std::chrono::steady_clock::now();
    const std::vector<float> means = cpca::fit_means(signal_, n_, labels_, cluster_count_, {});
    const cpca::PointsByCluster sorted = cpca::sort_by_cluster(labels_, cluster_count_);
    bases_.assign(cluster_count_ * count * n_, 0.0f);
    parallel_for(cluster_count_, 1, [&](std::size_t k, std::size_t) {
      if (sorted.of(k).empty()) return;
      std::copy_n(&means[k * n_], n_, &means_[k * n_]);
      if (count == 0) return;
      cpca::find_components(signal_, sorted.of(k),
                            {{&means_[k * n_], n_}, {&bases_[k * count * n_], count * n_}});
    });
    fit_seconds_ += seconds_since(start);
  }

  double dot(const float* a, const float* b) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < n_; ++i) sum += double{a[i]} * double{b[i]};
    return sum;
  }

  std::span<const float> signal_;
  std::size_t n_, cluster_count_;
  std::vector<float> means_, bases_;
  std::vector<std::uint32_t> labels_;
  std::vector<double> errors_;
  double product_seconds_ = 0.0, fit_seconds_ = 0.0;
};

void run(const signal::Matrix& signal, const cpca::Options& options) {
  fmt::print("{} points x {}, {} clusters, {} components, {} iterations each, seed {}\n",
             signal.row_count, signal.column_count, options.cluster_count, options.component_count,
             options.iterations, options.seed);
  auto start = std::chrono::steady_clock::now();
  double processor_start = processor_seconds();
  const cpca::Encoded encoded =
      cpca::encode_iterative(signal.values, static_cast<int>(signal.column_count), options);
  const double seconds = seconds_since(start);
  const double processor = processor_seconds() - processor_start;
  const double error =
      cpca::summarize(cpca::point_errors(encoded.encoding, signal.values), signal.values)
          .squared_error;
  fmt::print("  ours   {:8.2f} s, {:8.2f} of processors, SE {:.6g}:", seconds, processor, error);
  for (const cpca::Stage& stage : encoded.stages) {
    fmt::print(" {} {:.2f}", stage.name, stage.seconds);
  }
  fmt::print("; {:.0f} GFLOP/s of {:.0f} in registers\n", 1e-9 * encoded.flops / seconds,
             1e-9 * bench::peak_flops());
  std::fflush(stdout);
  start = std::chrono::steady_clock::now();
  processor_start = processor_seconds();
  Plain plain(signal, options);
  const double plain_error = plain.run(options);
  const double plain_seconds = seconds_since(start);
  const double plain_processor = processor_seconds() - processor_start;
  fmt::print(
      "  plain  {:8.2f} s, {:8.2f} of processors, SE {:.6g}: products {:.2f} ({:.0f} GFLOP/s), "
      "fits {:.2f}\n",
      plain_seconds, plain_processor, plain_error, plain.product_seconds(),
      1e-9 * static_cast<double>(signal.values.size()) * options.cluster_count *
          options.iterations * (options.component_count + 1) * (options.component_count + 2) /
          plain.product_seconds(),
      plain.fit_seconds());
  fmt::print("  {:.1f} times faster, {:.1f} by processor time, error {:+.2f}%\n",
             plain_seconds / seconds, plain_processor / processor,
             100.0 * (error / plain_error - 1.0));
}

}  // namespace

int main(int argc, char** argv) {
  const auto number = [&](int i, int otherwise) {
    return argc > i ? std::atoi(argv[i]) : otherwise;
  };
  signal::Matrix signal;
  if (argc > 1) {
    signal = signal::read_npy(argv[1]);
  } else {
    signal = {bench::make_signal(50000, 600), 50000, 600};
  }
  fmt::print("{} threads, {}\n", thread_count(), simd_level_name(simd_level()));
  run(signal, {.cluster_count = number(2, 256),
               .component_count = number(3, 8),
               .iterations = number(4, 15),
               .seed = static_cast<std::uint64_t>(number(5, 1))});
}
