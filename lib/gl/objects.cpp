#include "gl/objects.h"

#include <epoxy/gl.h>

#include <algorithm>

#include "core/error.h"
#include "gl/context.h"

namespace prt::gl {

namespace {

unsigned int generate(void (*generator)(GLsizei, GLuint*)) {
  GLuint name = 0;
  generator(1, &name);
  return name;
}

/// What OpenGL calls a Scalar: type of its numbers, format of textures of four of them.
struct ScalarType {
  GLenum type;
  GLboolean normalized;
  std::size_t bytes;
  GLenum texture_format;
};

ScalarType type_of(Scalar scalar) {
  switch (scalar) {
    case Scalar::float16:
      return {GL_HALF_FLOAT, GL_FALSE, 2, GL_RGBA16F};
    case Scalar::unorm16:
      return {GL_UNSIGNED_SHORT, GL_TRUE, 2, GL_RGBA16};
    case Scalar::unorm8:
      return {GL_UNSIGNED_BYTE, GL_TRUE, 1, GL_RGBA8};
    default:
      return {GL_FLOAT, GL_FALSE, 4, GL_RGBA32F};
  }
}

/// A constant power of two, so that the shader need not divide; OpenGL ES 3.0 promises as much.
constexpr std::size_t kTableRowLength = Table::kRowLength;

std::size_t table_height(std::size_t count) {
  return std::max<std::size_t>((count + kTableRowLength - 1) / kTableRowLength, 1);
}

int checked_height(std::size_t count) {
  if (!Table::fits(count))
    throw_failed("the model's data do not fit a texture of this OpenGL",
                 {.found = std::to_string(count) + " vec4"});
  return static_cast<int>(table_height(count));
}

const void* byte_offset(std::size_t offset) { return reinterpret_cast<const void*>(offset); }

}  // namespace

void delete_buffer(unsigned int name) { glDeleteBuffers(1, &name); }
void delete_texture(unsigned int name) { glDeleteTextures(1, &name); }
void delete_vertex_array(unsigned int name) { glDeleteVertexArrays(1, &name); }

// epoxy's calls are macros or function pointers, so that a lambda stands between.
Buffer::Buffer(std::span<const std::byte> bytes)
    : name_(generate([](GLsizei n, GLuint* names) { glGenBuffers(n, names); })) {
  glBindBuffer(GL_COPY_WRITE_BUFFER, name());
  glBufferData(GL_COPY_WRITE_BUFFER, static_cast<GLsizeiptr>(bytes.size()), bytes.data(),
               GL_STATIC_DRAW);
  check_errors("storing a buffer");
}

Buffer::Buffer(std::size_t byte_count)
    : name_(generate([](GLsizei n, GLuint* names) { glGenBuffers(n, names); })) {
  glBindBuffer(GL_COPY_WRITE_BUFFER, name());
  glBufferData(GL_COPY_WRITE_BUFFER, static_cast<GLsizeiptr>(byte_count), nullptr, GL_DYNAMIC_COPY);
  check_errors("making room in a buffer");
}

VertexArray::VertexArray()
    : name_(generate([](GLsizei n, GLuint* names) { glGenVertexArrays(n, names); })) {}

void VertexArray::bind() const { glBindVertexArray(name_.get()); }

void VertexArray::set_floats(unsigned int location, const Buffer& buffer, int component_count,
                             std::size_t stride, std::size_t offset, Scalar scalar) {
  const ScalarType type = type_of(scalar);
  bind();
  glBindBuffer(GL_ARRAY_BUFFER, buffer.name());
  glEnableVertexAttribArray(location);
  glVertexAttribPointer(location, component_count, type.type, type.normalized,
                        static_cast<GLsizei>(stride), byte_offset(offset));
}

void VertexArray::set_uints(unsigned int location, const Buffer& buffer, int component_count) {
  bind();
  glBindBuffer(GL_ARRAY_BUFFER, buffer.name());
  glEnableVertexAttribArray(location);
  glVertexAttribIPointer(location, component_count, GL_UNSIGNED_INT, 0, nullptr);
}

void VertexArray::set_indices(const Buffer& buffer) {
  bind();
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffer.name());
}

Texture::Texture(Format format, int width, int height, const float* pixels)
    : Texture(format == Format::rgba16f ? GL_RGBA16F : GL_RGBA32F, GL_FLOAT, width, height,
              pixels) {}

Texture::Texture(unsigned int format, unsigned int type, int width, int height, const void* pixels)
    : name_(generate([](GLsizei n, GLuint* names) { glGenTextures(n, names); })),
      width_(width),
      height_(height) {
  const int limit = limits().max_texture_size;
  if (width > limit || height > limit)
    throw_failed("a texture is larger than this OpenGL allows",
                 {.found = std::to_string(width) + "x" + std::to_string(height),
                  .expected = "at most " + std::to_string(limit) + " pixels a side"});
  glBindTexture(GL_TEXTURE_2D, name());
  glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(format), width, height, 0, GL_RGBA, type,
               pixels);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  check_errors("storing a texture");
}

void Texture::bind(int unit) const {
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_2D, name());
}

bool Table::fits(std::size_t count) {
  return table_height(count) <= static_cast<std::size_t>(limits().max_texture_size);
}

Table::Table(std::size_t count, Scalar scalar)
    : Texture(type_of(scalar).texture_format, type_of(scalar).type,
              static_cast<int>(kTableRowLength), checked_height(count), nullptr),
      count_(count),
      scalar_(scalar) {}

void Table::upload(std::span<const std::byte> values) {
  if (values.size() != count_ * 4 * type_of(scalar_).bytes) throw_failed("a table keeps its size");
  copy(reinterpret_cast<std::uintptr_t>(values.data()), 0, count_);
}

void Table::upload(const Buffer& buffer, std::size_t first, std::size_t count) {
  if (first % kRowLength != 0 || first + count > count_)
    throw_failed("a part of a table begins within a row or goes beyond its end");
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, buffer.name());
  copy(0, first, count);
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
}

/// From an address, or from a place in the bound buffer. Bound textures stay bound.
void Table::copy(std::uintptr_t source, std::size_t first, std::size_t count) {
  GLint bound = 0;
  glGetIntegerv(GL_TEXTURE_BINDING_2D, &bound);
  glBindTexture(GL_TEXTURE_2D, name());
  const ScalarType type = type_of(scalar_);
  const std::size_t full_rows = count / kRowLength, rest = count % kRowLength;
  const auto put = [&](std::size_t row, std::size_t width, std::size_t height) {
    if (width == 0 || height == 0) return;
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, static_cast<GLint>(first / kRowLength + row),
                    static_cast<GLsizei>(width), static_cast<GLsizei>(height), GL_RGBA, type.type,
                    byte_offset(source + row * kRowLength * 4 * type.bytes));
  };
  put(0, kRowLength, full_rows);
  put(full_rows, rest, 1);
  glBindTexture(GL_TEXTURE_2D, static_cast<GLuint>(bound));
  check_errors("uploading a table");
}

Capture::Capture(const Buffer& buffer, std::size_t offset, std::size_t byte_count) {
  glEnable(GL_RASTERIZER_DISCARD);
  glBindBufferRange(GL_TRANSFORM_FEEDBACK_BUFFER, 0, buffer.name(), static_cast<GLintptr>(offset),
                    static_cast<GLsizeiptr>(byte_count));
  glBeginTransformFeedback(GL_POINTS);
}

void draw_points(std::size_t first, std::size_t count) {
  glDrawArrays(GL_POINTS, static_cast<GLint>(first), static_cast<GLsizei>(count));
}

Capture::~Capture() {
  glEndTransformFeedback();
  glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, 0);
  glDisable(GL_RASTERIZER_DISCARD);
}

TextureArray::TextureArray(int size, std::span<const Vec4> texels)
    : name_(generate([](GLsizei n, GLuint* names) { glGenTextures(n, names); })) {
  const auto layer_size = static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
  glBindTexture(GL_TEXTURE_2D_ARRAY, name_.get());
  glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, limits().float32_filters ? GL_RGBA32F : GL_RGBA16F, size,
               size, static_cast<GLsizei>(texels.size() / layer_size), 0, GL_RGBA, GL_FLOAT,
               texels.data());
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    glTexParameteri(GL_TEXTURE_2D_ARRAY, filter, GL_LINEAR);
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    glTexParameteri(GL_TEXTURE_2D_ARRAY, wrap, GL_CLAMP_TO_EDGE);
  check_errors("storing an array of textures");
}

void TextureArray::bind(int unit) const {
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_2D_ARRAY, name_.get());
}

}  // namespace prt::gl
