// The engine for large scenes: single rays through the tree that their shadow rays use, which may
// lie in mapped files (ray/wide_tree.h), where Embree's own tree would have to be in memory. As
// tight as ShadowTree: no ray passes between triangles that share corners, not even one that is
// aimed at a vertex.
#pragma once

#include <memory>

#include "core/cpu.h"
#include "ray/engine.h"
#include "ray/wide_tree.h"

namespace prt::ray {

std::unique_ptr<Engine> make_wide_engine(std::shared_ptr<const WideTree> tree,
                                         SimdLevel level = simd_level());

}  // namespace prt::ray
