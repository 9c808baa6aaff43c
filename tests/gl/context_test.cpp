#include "gl/context.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <vector>

#include "core/error.h"
#include "gl/objects.h"
#include "gl/program.h"

namespace prt::gl {
namespace {

namespace fs = std::filesystem;

class EveryApi : public testing::TestWithParam<Api> {
 protected:
  HeadlessContext context_{{.api = GetParam()}};
};
INSTANTIATE_TEST_SUITE_P(Context, EveryApi, testing::Values(Api::core_3_3, Api::es_3_0));

TEST_P(EveryApi, ReportsLimitsThatTheStandardGuarantees) {
  const Limits found = limits();
  EXPECT_GE(found.max_texture_size, 1024);
  EXPECT_GE(found.max_vertex_attributes, 16);
  EXPECT_GE(found.max_vertex_uniform_vectors, 256);
  EXPECT_GE(found.max_samples, 1);
  EXPECT_FALSE(description().empty());
}

TEST_P(EveryApi, FloatTargetKeepsWhatIsDrawn) {
  for (const int samples : {1, limits().max_samples}) {
    const Format format = limits().float32_targets ? Format::rgba32f : Format::rgba16f;
    const Target target(format, 3, 2, true, samples);
    const Program program("fullscreen.vert", "black.frag");
    const VertexArray none;
    target.bind();
    program.use();
    draw_fullscreen(none);
    target.resolve();
    std::vector<float> pixels(3 * 2 * 4, -1.0f);
    target.read(pixels);
    for (std::size_t i = 0; i < pixels.size(); ++i) EXPECT_EQ(pixels[i], i % 4 == 3 ? 1.0f : 0.0f);
    std::vector<float> too_small(4);
    EXPECT_THROW(target.read(too_small), Error);
  }
}

TEST_P(EveryApi, TextureOfADrawnTargetRoundTrips) {
  std::vector<float> pixels(5 * 4 * 4);
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = 0.25f * static_cast<float>(i) - 3;
  for (std::size_t i = 3; i < pixels.size(); i += 4) pixels[i] = 1;  // covered
  const Texture source(Format::rgba32f, 5, 4, pixels.data());
  const Target target(Format::rgba32f, 5, 4, false, 1);
  const Program program("fullscreen.vert", "composite.frag");
  const VertexArray none;
  target.bind();
  program.use();
  program.set("u_scene", 0);
  program.set("u_environment", 1);
  source.bind(0);
  source.bind(1);
  draw_fullscreen(none);
  std::vector<float> read(pixels.size());
  target.read(read);
  EXPECT_EQ(read, pixels);
}

TEST_P(EveryApi, TablesSpanRowsOfATexture) {
  constexpr std::size_t kCount = 5000;  // two rows and a part
  std::vector<Vec4> values(kCount);
  for (std::size_t i = 0; i < kCount; ++i) values[i] = Vec4(static_cast<float>(i), 1, 2, 3);
  Table table(kCount);
  table.upload(values);
  EXPECT_GT(table.height(), 1);
  EXPECT_THROW(table.upload(std::span(values).first(10)), Error);
}

TEST_P(EveryApi, CaptureKeepsWhatAVertexShaderOutputs) {
  const Program program("fullscreen.vert", "black.frag", {}, "v_ndc");
  const VertexArray none;
  const Buffer buffer(4 * 2 * sizeof(float));
  const Target target(limits().float32_targets ? Format::rgba32f : Format::rgba16f, 2, 2, false, 1);
  target.bind();
  {
    none.bind();
    program.use();
    const Capture capture(buffer, 0, 4 * 2 * sizeof(float));
    draw_points(0, 4);
  }
  Table table(Table::kRowLength + 2);
  const std::vector<float> zeros(4 * table.count());
  table.upload(std::as_bytes(std::span(zeros)));
  EXPECT_THROW(table.upload(buffer, 1, 2), Error);
  EXPECT_THROW(table.upload(buffer, Table::kRowLength, 3), Error);
  table.upload(buffer, Table::kRowLength, 2);
  const Program copy("fullscreen.vert", "composite.frag");
  copy.use();
  copy.set("u_scene", 0);
  table.bind(0);
  draw_fullscreen(none);
  std::vector<float> read(16);
  target.read(read);
  EXPECT_EQ(read, (std::vector<float>{0, 0, 0, 0, 0, 0, 0, 0, -1, -1, 3, -1, -1, 3, 3, 3}));
}

TEST_P(EveryApi, OversizedTextureIsAnErrorThatSaysTheLimit) {
  const int limit = limits().max_texture_size;
  try {
    const Texture texture(Format::rgba16f, limit + 1, 1);
    FAIL() << "made";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(std::to_string(limit)), std::string::npos);
  }
}

class ShaderFolder : public testing::Test {
 protected:
  ShaderFolder() {
    fs::create_directories(folder_);
    setenv("PRTKIT_SHADER_DIR", folder_.c_str(), 1);
    write("ok.vert", "void main() { gl_Position = vec4(0.0); }\n");
    write("ok.frag", "out vec4 color;\nvoid main() { color = vec4(1.0); }\n");
  }
  ~ShaderFolder() override {
    unsetenv("PRTKIT_SHADER_DIR");
    fs::remove_all(folder_);
  }
  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
  }
  std::string message(const std::string& vertex, const std::string& fragment) {
    try {
      const Program program(vertex, fragment);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }

  HeadlessContext context_;
  fs::path folder_ = fs::path(testing::TempDir()) / "prtkit_shaders";
};

TEST_F(ShaderFolder, CompileErrorNamesFileAndLine) {
  write("bad.frag", "out vec4 color;\nvoid main() {\n  color = vec4(undefined_name);\n}\n");
  EXPECT_NE(message("ok.vert", "bad.frag").find("bad.frag:3"), std::string::npos)
      << message("ok.vert", "bad.frag");
}

TEST_F(ShaderFolder, CompileErrorInAnIncludedFileNamesThatFile) {
  write("part.glsl", "float one() { return 1.0; }\nfloat two() { return nothing; }\n");
  write("outer.frag",
        "#include \"part.glsl\"\n#include \"part.glsl\"\nout vec4 c;\nvoid main() { c = "
        "vec4(one()); }\n");
  EXPECT_NE(message("ok.vert", "outer.frag").find("part.glsl:2"), std::string::npos);
  write("part.glsl", "float one() { return 1.0; }\n");
  EXPECT_EQ(message("ok.vert", "outer.frag"), "no error");
  write("outer.frag", "#include \"part.glsl\"\nout vec4 c;\nvoid main() { c = vec4(oops); }\n");
  EXPECT_NE(message("ok.vert", "outer.frag").find("outer.frag:3"), std::string::npos);
}

TEST_F(ShaderFolder, MissingShaderIsNamed) {
  EXPECT_NE(message("ok.vert", "none.frag").find("none.frag"), std::string::npos);
}

TEST_F(ShaderFolder, StagesThatDoNotFitAreALinkError) {
  write("gives.vert", "out vec2 v;\nvoid main() { v = vec2(1.0); gl_Position = vec4(0.0); }\n");
  write("needs.frag", "in vec3 v;\nout vec4 c;\nvoid main() { c = vec4(v, 1.0); }\n");
  EXPECT_NE(message("gives.vert", "needs.frag").find("needs.frag"), std::string::npos);
}

TEST(Context, SecondContextWorksAfterTheFirstIsGone) {
  { const HeadlessContext first; }
  const HeadlessContext second;
  EXPECT_GE(limits().max_texture_size, 1024);
}

}  // namespace
}  // namespace prt::gl
