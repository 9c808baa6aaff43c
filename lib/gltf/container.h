// The outside of a glTF file: .glb chunks or plain JSON, buffers and images wherever they are.
#pragma once

#include <span>

#include "gltf/state.h"

namespace prt::gltf {

/// Parses the file's bytes and fetches every buffer and image into memory; images become views of
/// a buffer. Checks as it goes, and only what it touches (gltf/check.h does the rest). Reads files
/// beside state.file, none elsewhere, and in all no more than the limit. Throws Error (bad_input).
void load_container(State& state, std::span<const std::byte> bytes);

/// The bytes of a .glb file with one buffer. The same state gives the same bytes.
Bytes make_glb(const State& state);

/// What a base64 data URI holds. Throws Error (bad_input).
Bytes decode_data_uri(std::string_view uri, const Where& where);

}  // namespace prt::gltf
