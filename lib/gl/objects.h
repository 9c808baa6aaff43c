// OpenGL objects as values: made in the constructor, deleted in the destructor, moved, never
// copied. All need a current context. Failures are Error (failed).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "core/vec.h"
#include "image/image.h"

namespace prt::gl {

/// An OpenGL name and the call that deletes it.
template <void (*kDelete)(unsigned int)>
class Name {
 public:
  Name() = default;
  explicit Name(unsigned int value) : value_(value) {}
  Name(Name&& other) noexcept : value_(std::exchange(other.value_, 0)) {}
  Name& operator=(Name&& other) noexcept {
    std::swap(value_, other.value_);
    return *this;
  }
  ~Name() {
    if (value_ != 0) kDelete(value_);
  }
  unsigned int get() const { return value_; }

 private:
  unsigned int value_ = 0;
};

void delete_buffer(unsigned int name);
void delete_texture(unsigned int name);
void delete_renderbuffer(unsigned int name);
void delete_framebuffer(unsigned int name);
void delete_vertex_array(unsigned int name);

/// How numbers that shaders read as floats are stored; integers are normalised, shares of the
/// greatest.
enum class Scalar { float32, float16, unorm16, unorm8 };

/// Vertex or index data, immutable; or room for what a gl::Capture writes.
class Buffer {
 public:
  Buffer() = default;
  template <class T>
  explicit Buffer(std::span<const T> values) : Buffer(std::as_bytes(values)) {}
  explicit Buffer(std::span<const std::byte> bytes);
  /// Nothing yet.
  explicit Buffer(std::size_t byte_count);
  unsigned int name() const { return name_.get(); }

 private:
  Name<delete_buffer> name_;
};

/// What a draw call reads: attributes by location, and triangles' indices (std::uint32_t).
class VertexArray {
 public:
  VertexArray();
  /// `component_count` numbers for each vertex, `stride` and `offset` in bytes.
  void set_floats(unsigned int location, const Buffer& buffer, int component_count,
                  std::size_t stride, std::size_t offset, Scalar scalar = Scalar::float32);
  /// `component_count` of std::uint32_t for each vertex, tightly packed.
  void set_uints(unsigned int location, const Buffer& buffer, int component_count = 1);
  void set_indices(const Buffer& buffer);
  void bind() const;

 private:
  Name<delete_vertex_array> name_;
};

enum class Format { rgba16f, rgba32f };

/// One level, no filtering (shaders fetch texels and interpolate where they must).
class Texture {
 public:
  Texture() = default;
  /// `pixels`: width × height × 4 floats, first row at texel row 0, or null for none yet.
  Texture(Format format, int width, int height, const float* pixels = nullptr);
  void bind(int unit) const;
  unsigned int name() const { return name_.get(); }
  int width() const { return width_; }
  int height() const { return height_; }

 protected:
  /// OpenGL's internal format, and the type of its components.
  Texture(unsigned int format, unsigned int type, int width, int height, const void* pixels);

  Name<delete_texture> name_;
  int width_ = 0, height_ = 0;
};

/// A one-dimensional array of vec4 as large as textures can be: element i is texel (i % 2048,
/// i / 2048) of a texture; table.glsl has the fetch.
class Table : public Texture {
 public:
  static constexpr std::size_t kRowLength = 2048;

  Table() = default;
  /// unorm16 only where Limits says so.
  explicit Table(std::size_t count, Scalar scalar = Scalar::float32);
  /// All elements; the same number as at construction.
  void upload(std::span<const Vec4> values) { upload(std::as_bytes(values)); }
  void upload(std::span<const std::byte> values);
  /// The first `count` elements of a buffer, inside of OpenGL, to element `first` on, where a row
  /// begins (kRowLength).
  void upload(const Buffer& buffer, std::size_t first, std::size_t count);
  std::size_t count() const { return count_; }
  /// Whether a table of so many elements is within the limits of this OpenGL.
  static bool fits(std::size_t count);

 private:
  void copy(std::uintptr_t source, std::size_t first, std::size_t count);

  std::size_t count_ = 0;
  Scalar scalar_ = Scalar::float32;
};

/// While it lives, drawn points are not drawn: what the program in use captures of each (the
/// outputs of its vertex shader that gl::Program was told) is written to `buffer`, one point after
/// the other, from byte `offset` on; at most `byte_count`. A framebuffer must be bound all the
/// same.
class Capture {
 public:
  Capture(const Buffer& buffer, std::size_t offset, std::size_t byte_count);
  ~Capture();
  Capture(const Capture&) = delete;
  Capture& operator=(const Capture&) = delete;
};

/// Layers of square images, filtered bilinearly within a layer, edges clamped: RGBA32F, or RGBA16F
/// where that cannot be filtered.
class TextureArray {
 public:
  TextureArray() = default;
  /// `texels`: layer after layer of size × size, first row at texel row 0.
  TextureArray(int size, std::span<const Vec4> texels);
  void bind(int unit) const;

 private:
  Name<delete_texture> name_;
};

/// A colour texture, and when asked depth and multisampling (resolve() then brings the samples'
/// mean into the texture, and everything drawn goes where it went before).
class Target {
 public:
  Target() = default;
  Target(Format format, int width, int height, bool depth, int samples);
  /// Everything drawn from now on goes here.
  void bind() const;
  void resolve() const;
  const Texture& color() const { return color_; }
  /// The samples as a sampler2DMS; with multisampling, where Limits::sample_textures.
  void bind_samples(int unit) const;
  int width() const { return color_.width(); }
  int height() const { return color_.height(); }
  /// The resolved colours, width × height × 4 floats, bottom row first.
  void read(std::span<float> pixels) const;

 private:
  Texture color_;
  Name<delete_framebuffer> framebuffer_;
  Name<delete_renderbuffer> samples_, depth_;
  Name<delete_texture> sample_texture_;  // instead of samples_ where it can be
  Name<delete_framebuffer> sample_framebuffer_;
};

/// Draws to the window again.
void bind_window(int width, int height);
/// What has been drawn to it since the last swap: linear RGB, first row on top.
image::Image read_window(int width, int height);

/// `count` vertices of the bound array from number `first` on, to be captured.
void draw_points(std::size_t first, std::size_t count);

/// Runs the program in use over the whole viewport; its vertex shader is fullscreen.vert. The array
/// has no attributes.
void draw_fullscreen(const VertexArray& no_attributes);

}  // namespace prt::gl
