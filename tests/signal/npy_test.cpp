// Matrices in .npy files, and files that are none.
#include "signal/npy.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <limits>

#include "core/error.h"
#include "signal/npz.h"

namespace prt::signal {
namespace {

namespace fs = std::filesystem;

class Npy : public testing::Test {
 protected:
  ~Npy() override { fs::remove(path_); }

  /// A file of the given dictionary and values.
  template <class T>
  void write(const std::string& dictionary, const std::vector<T>& values, char version = 1) {
    std::string bytes = std::string("\x93NUMPY") + version + '\0';
    const auto length = static_cast<std::uint32_t>(dictionary.size());
    bytes.append(reinterpret_cast<const char*>(&length), version == 1 ? 2 : 4);
    bytes += dictionary;
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    write_bytes(bytes);
  }
  void write_bytes(const std::string& bytes) { std::ofstream(path_, std::ios::binary) << bytes; }

  std::string message() const {
    try {
      read_npy(path_, 1000);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::bad_input);
      return error.what();
    }
    return "no error";
  }

  fs::path path_ = fs::path(testing::TempDir()) / "prt_npy_test.npy";
};

std::string dictionary(const std::string& type, const std::string& shape) {
  return "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape + ", }\n";
}

TEST_F(Npy, ReadsFloatsAndDoublesOfAllVersions) {
  const std::vector<float> values{1, -2, 3.5, 4, 5, 6};
  for (char version : {1, 2, 3}) {
    write(dictionary("<f4", "(2, 3)"), values, version);
    const Matrix matrix = read_npy(path_);
    EXPECT_EQ(matrix.row_count, 2u);
    EXPECT_EQ(matrix.column_count, 3u);
    EXPECT_EQ(matrix.values, values);
  }
  write(dictionary("<f8", "(3, 2)"), std::vector<double>(values.begin(), values.end()));
  EXPECT_EQ(read_npy(path_).values, values);
  EXPECT_EQ(read_npy(path_).row_count, 3u);
  std::vector<double> many(10000);
  for (std::size_t i = 0; i < many.size(); ++i) many[i] = static_cast<double>(i);
  write(dictionary("<f8", "(100, 100)"), many);
  EXPECT_EQ(read_npy(path_).values, std::vector<float>(many.begin(), many.end()));
  write(dictionary("<f4", "(6,)"), values);
  EXPECT_EQ(read_npy(path_).row_count, 6u);
  EXPECT_EQ(read_npy(path_).values, values);
}

TEST_F(Npy, NamesTheRowOfWhatIsNoFiniteFloat) {
  std::vector<float> values(6);
  values[4] = std::numeric_limits<float>::quiet_NaN();
  write(dictionary("<f4", "(3, 2)"), values);
  EXPECT_EQ(message(), path_.string() +
                           ": row 2, column 0: not a finite number: found nan, expected up to "
                           "3.4e+38");
  std::vector<double> doubles(6);
  doubles[5] = -1e39;
  write(dictionary("<f8", "(3, 2)"), doubles);
  EXPECT_NE(message().find("row 2, column 1: beyond the range of float: found -1e+39"),
            std::string::npos);
  doubles[5] = std::numeric_limits<double>::infinity();
  write(dictionary("<f8", "(3, 2)"), doubles);
  EXPECT_NE(message().find("row 2, column 1: not a finite number: found inf"), std::string::npos);
}

TEST_F(Npy, ReadsItsOwnHeader) {
  const std::vector<float> values{1, 2, 3};
  for (const std::vector<std::size_t>& shape : {std::vector<std::size_t>{3, 1}, {1, 3}, {3}}) {
    const std::string header = npy_header("<f4", shape);
    EXPECT_EQ(header.size() % 64, 0u);
    write_bytes(header + std::string(reinterpret_cast<const char*>(values.data()), 12));
    const Matrix matrix = read_npy(path_);
    EXPECT_EQ(matrix.values, values);
    EXPECT_EQ(matrix.row_count, shape.front());
  }
}

TEST_F(Npy, BytesOfArchivesAreThoseOfTheFile) {
  const std::vector<float> none, some(12);
  for (const std::vector<float>& values : {none, some}) {
    const std::vector<Array> arrays{
        make_array("a", "<f4", {values.size() / 3, 3}, values),
        make_array("another_name", "<f4", {values.size()}, values),
    };
    write_npz(path_, arrays);
    EXPECT_EQ(npz_bytes(arrays), fs::file_size(path_));
  }
}

TEST_F(Npy, RefusesWhatIsNoMatrixOfFloats) {
  const std::vector<float> values(6);
  const std::string file = path_.string();
  write(dictionary("<i4", "(2, 3)"), values);
  EXPECT_EQ(message(), file +
                           ": values of another type: found '<i4', expected '<f4' or '<f8' "
                           "(float32 or float64, little-endian)");
  write("{'descr': '<f4', 'fortran_order': True, 'shape': (2, 3), }", values);
  EXPECT_EQ(message(), file +
                           ": values column by column: found 'fortran_order': True, expected C "
                           "order");
  write(dictionary("<f4", "(1, 2, 3)"), values);
  EXPECT_NE(message().find("not a matrix: found (1, 2, 3)"), std::string::npos);
  write(dictionary("<f4", "(0, 3)"), std::vector<float>());
  EXPECT_NE(message().find("no values"), std::string::npos);
  write(dictionary("<f4", "()"), values);
  EXPECT_NE(message().find("no values"), std::string::npos);
  write(dictionary("<f4", "(-2, 3)"), values);
  EXPECT_NE(message().find("not a matrix"), std::string::npos);
  write(dictionary("<f4", "(2, 4)"), values);
  EXPECT_EQ(message(), file +
                           ": file of another length: found 24 bytes of values, expected 32 for "
                           "2 × 4");
  write(dictionary("<f4", "(99999999999, 99999999999)"), values);
  EXPECT_NE(message().find("overflows"), std::string::npos);
  write(dictionary("<f4", "(20, 20)"), std::vector<float>(400));
  EXPECT_EQ(message(), file +
                           ": too large: found 20 × 20 values, 1600 bytes of memory, expected at "
                           "most 1000 bytes. Take fewer rows or columns, or a machine of more "
                           "memory.");
  write("{'descr': '<f4'}", values);
  EXPECT_NE(message().find("broken header: found no 'fortran_order'"), std::string::npos);
  write_bytes("\x93NUMPY");
  EXPECT_NE(message().find("header cut off"), std::string::npos);
  write_bytes("P6 hello world");
  EXPECT_NE(message().find("not a .npy file"), std::string::npos);
}

}  // namespace
}  // namespace prt::signal
