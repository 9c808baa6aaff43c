// The per-vertex transfer signal, and its file: what prt-transfer writes and prt-compress reads.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "mesh/scene.h"

namespace prt::signal {

/// Of signals in files.
constexpr int kMaxDimension = 8192;

/// Transfer of all vertices of a scene (numbered through). One vertex is one row of
/// `dimension()` floats, ordered [channel][exit row][source coefficient]; diffuse transfer has one
/// exit row. Maps source radiance coefficients (world frame) to exit radiance, albedo/pi included.
struct TransferSignal {
  int band_count = 0;     ///< of the source light
  int row_count = 1;      ///< exit coefficients; 1 is diffuse
  int channel_count = 1;  ///< 1, or 3 (R, G, B)
  std::string brdf = "lambert";
  std::uint64_t seed = 0;
  int ray_count = 0;
  int bounce_count = 0;
  std::string tool_version;
  std::string mesh_hash;  ///< mesh::mesh_hash of the scene it was computed for; empty: not known

  struct Block {
    std::string name;  ///< of the primitive
    std::size_t vertex_count;
  };
  std::vector<Block> blocks;  ///< one a primitive, in scene order
  std::vector<float> values;  ///< vertex_count() × dimension()

  int dimension() const { return channel_count * row_count * band_count * band_count; }
  std::size_t vertex_count() const;
};

/// Writes the OpenEXR form (docs/transfer-file.md), atomically; the same signal gives the same
/// bytes. Throws Error (failed).
void write_transfer(const std::filesystem::path& path, const TransferSignal& signal,
                    bool no_clobber = false);

/// Rows of the vertices [first, first + count), count × dimension() values.
using RowSource =
    std::function<void(std::size_t first, std::size_t count, std::span<float> values)>;

/// The same file of a signal that is never in memory as a whole: `signal.values` is not looked at,
/// `rows` is asked for all vertices in order, a few thousand at a time.
void write_transfer(const std::filesystem::path& path, const TransferSignal& signal,
                    const RowSource& rows, bool no_clobber = false);

/// Reads it back, bit for bit. Throws Error (bad_input), naming the file and what is wrong in it,
/// before taking memory for values that would need more than `max_bytes`.
TransferSignal read_transfer(const std::filesystem::path& path,
                             std::size_t max_bytes = std::size_t{16} << 30);

/// Throws Error (bad_input) when the signal was computed for another mesh: when vertex counts or
/// hashes differ. Warns of a hash that cannot be compared (mesh::match_mesh_hash); without one only
/// the counts are checked.
void check_belongs_to(const TransferSignal& signal, const mesh::Scene& scene,
                      const std::filesystem::path& signal_path);

}  // namespace prt::signal
