// Overdraw of clusters over a mesh [Sloan03] §5: a triangle is drawn once for each cluster that its
// vertices belong to. Labels may be clusters or superclusters; every index is of a labelled point.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace prt::cpca {

/// Calls visit(label) once for each different label among three.
template <class Visit>
void for_each_label(std::uint32_t a, std::uint32_t b, std::uint32_t c, Visit visit) {
  visit(a);
  if (b != a) visit(b);
  if (c != a && c != b) visit(c);
}

/// Triangles sent to the hardware: each as often as it has different labels.
std::size_t sent_triangle_count(std::span<const std::uint32_t> indices,
                                std::span<const std::uint32_t> label_of_point);

/// Triangles sent for each of the mesh, 1 to 3; 1 without triangles.
double overdraw(std::size_t sent_count, std::size_t triangle_count);

}  // namespace prt::cpca
