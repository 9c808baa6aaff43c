// What images are: by their bytes, whatever the file says.
#pragma once

#include "gltf/state.h"

namespace prt::gltf {

/// Sets the type of every image. Of a document that check_document has passed. Throws Error
/// (bad_input) for images of types that neither glTF nor an extension that the file uses names.
void name_image_types(State& state);

}  // namespace prt::gltf
