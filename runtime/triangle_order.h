// Triangles in an order in which neighbours follow each other. GPUs keep the last few vertices that
// they have shaded: a triangle that shares them with the ones before it costs less. The order of a
// file can be any, and vertices of glossy transfer are dear.
//
// [Sander07] Sander, Nehab, Barczak: Fast triangle reordering for vertex locality and reduced
// overdraw, SIGGRAPH 2007, §3.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt::runtime {

/// The same triangles, each with its corners as they were, in linear time. `indices`: three a
/// triangle, below `vertex_count`.
std::vector<std::uint32_t> ordered_for_vertex_reuse(std::span<const std::uint32_t> indices,
                                                    std::size_t vertex_count);

}  // namespace prt::runtime
