#include <epoxy/gl.h>

#include <vector>

#include "core/error.h"
#include "gl/context.h"
#include "gl/objects.h"
#include "image/srgb.h"

namespace prt::gl {

namespace {

GLenum sized_format(Format format) { return format == Format::rgba16f ? GL_RGBA16F : GL_RGBA32F; }

unsigned int make_renderbuffer(GLenum format, int samples, int width, int height) {
  GLuint name = 0;
  glGenRenderbuffers(1, &name);
  glBindRenderbuffer(GL_RENDERBUFFER, name);
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples > 1 ? samples : 0, format, width,
                                   height);
  return name;
}

unsigned int make_sample_texture(GLenum format, int samples, int width, int height) {
  GLuint name = 0;
  glGenTextures(1, &name);
  glBindTexture(GL_TEXTURE_2D_MULTISAMPLE, name);
  glTexImage2DMultisample(GL_TEXTURE_2D_MULTISAMPLE, samples, format, width, height, GL_TRUE);
  return name;
}

unsigned int make_framebuffer() {
  GLuint name = 0;
  glGenFramebuffers(1, &name);
  glBindFramebuffer(GL_FRAMEBUFFER, name);
  return name;
}

void attach(GLenum attachment, unsigned int renderbuffer) {
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER, renderbuffer);
}

void check_complete() {
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw_failed("this OpenGL cannot draw to the framebuffer that was asked for");
}

}  // namespace

void delete_renderbuffer(unsigned int name) { glDeleteRenderbuffers(1, &name); }
void delete_framebuffer(unsigned int name) { glDeleteFramebuffers(1, &name); }

Target::Target(Format format, int width, int height, bool depth, int samples)
    : color_(format, width, height), framebuffer_(make_framebuffer()) {
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color_.name(), 0);
  if (samples > 1) {
    check_complete();
    sample_framebuffer_ = Name<delete_framebuffer>(make_framebuffer());
    if (limits().sample_textures) {
      sample_texture_ =
          Name<delete_texture>(make_sample_texture(sized_format(format), samples, width, height));
      glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D_MULTISAMPLE,
                             sample_texture_.get(), 0);
    } else {
      samples_ = Name<delete_renderbuffer>(
          make_renderbuffer(sized_format(format), samples, width, height));
      attach(GL_COLOR_ATTACHMENT0, samples_.get());
    }
  }
  if (depth) {
    depth_ =
        Name<delete_renderbuffer>(make_renderbuffer(GL_DEPTH_COMPONENT24, samples, width, height));
    attach(GL_DEPTH_ATTACHMENT, depth_.get());
  }
  check_complete();
  check_errors("making a framebuffer");
}

void Target::bind() const {
  const unsigned int drawn = sample_framebuffer_.get();
  glBindFramebuffer(GL_FRAMEBUFFER, drawn != 0 ? drawn : framebuffer_.get());
  glViewport(0, 0, width(), height());
}

void Target::resolve() const {
  if (sample_framebuffer_.get() == 0) return;
  GLint drawn = 0;
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &drawn);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, sample_framebuffer_.get());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_.get());
  glBlitFramebuffer(0, 0, width(), height(), 0, 0, width(), height(), GL_COLOR_BUFFER_BIT,
                    GL_NEAREST);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<GLuint>(drawn));
}

void Target::bind_samples(int unit) const {
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_2D_MULTISAMPLE, sample_texture_.get());
}

void Target::read(std::span<float> pixels) const {
  const auto count = static_cast<std::size_t>(width()) * static_cast<std::size_t>(height()) * 4;
  if (pixels.size() != count) throw_failed("an image of another size was given to read into");
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.get());
  glReadPixels(0, 0, width(), height(), GL_RGBA, GL_FLOAT, pixels.data());
  check_errors("reading pixels");
}

void bind_window(int width, int height) {
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(0, 0, width, height);
}

image::Image read_window(int width, int height) {
  const auto row_bytes = static_cast<std::size_t>(width) * 4;
  std::vector<unsigned char> bytes(row_bytes * static_cast<std::size_t>(height));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, bytes.data());
  check_errors("reading the window");
  image::Image image(width, height, 3);
  for (int y = 0; y < height; ++y) {
    const unsigned char* const row = &bytes[row_bytes * static_cast<std::size_t>(height - 1 - y)];
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c)
        image.at(x, y)[c] = image::linear_from_srgb(static_cast<float>(row[4 * x + c]) / 255.0f);
  }
  return image;
}

void draw_fullscreen(const VertexArray& no_attributes) {
  no_attributes.bind();
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace prt::gl
