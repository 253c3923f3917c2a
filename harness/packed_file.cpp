#include "harness/packed_file.h"

#include <filesystem>
#include <memory>
#include <vector>

#include <fmt/format.h>

#include "engine/scene/error.h"
#include "harness/text_file.h"

#ifdef PLUMB_WITH_ZSTD
#include <zstd.h>
#endif

namespace plumb::harness {
namespace {

namespace fs = std::filesystem;

constexpr const char* kEnding = ".zst";
// Size of a disk block, bytes: compressing a smaller file saves nothing.
[[maybe_unused]] constexpr std::uintmax_t kBlock = 4096;

[[noreturn, maybe_unused]] void fail(const std::string& path, Error::Kind kind, const std::string& problem) {
  throw Error(kind, fmt::format("file '{}'", path), "", "", problem);
}

#ifdef PLUMB_WITH_ZSTD

std::string compressed(const std::string& path, const std::string& text) {
  const std::unique_ptr<ZSTD_CCtx, std::size_t (*)(ZSTD_CCtx*)> context(ZSTD_createCCtx(), ZSTD_freeCCtx);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag, 1);
  std::string out(ZSTD_compressBound(text.size()), '\0');
  const std::size_t size = ZSTD_compress2(context.get(), out.data(), out.size(), text.data(), text.size());
  if (ZSTD_isError(size) != 0)
    fail(path, Error::Kind::Io, fmt::format("cannot be compressed: {}", ZSTD_getErrorName(size)));
  out.resize(size);
  return out;
}

// Decompresses piece by piece, so that the part before a truncation is returned.
std::string decompressed(const std::string& path, const std::string& packed) {
  const std::unique_ptr<ZSTD_DCtx, std::size_t (*)(ZSTD_DCtx*)> context(ZSTD_createDCtx(), ZSTD_freeDCtx);
  std::string text;
  std::vector<char> piece(ZSTD_DStreamOutSize());
  ZSTD_inBuffer in{packed.data(), packed.size(), 0};
  for (bool more = true; more;) {
    ZSTD_outBuffer out{piece.data(), piece.size(), 0};
    const std::size_t left = ZSTD_decompressStream(context.get(), &out, &in);
    if (ZSTD_isError(left) != 0)
      fail(path, Error::Kind::Syntax, fmt::format("cannot be decompressed: {}", ZSTD_getErrorName(left)));
    text.append(piece.data(), out.pos);
    more = in.pos < in.size || out.pos == out.size;
  }
  return text;
}

#else

std::string decompressed(const std::string& path, const std::string&) {
  fail(path, Error::Kind::Unsupported,
       "is compressed, and this plumb is built without zstd: install libzstd-dev and build again");
}

#endif

}  // namespace

#ifdef PLUMB_WITH_ZSTD

void pack_files(const std::string& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file() && entry.path().extension() == ".jsonl" && entry.file_size() > kBlock)
      files.push_back(entry.path());
  for (const fs::path& file : files) {
    write_whole(file.string() + kEnding, compressed(file.string(), read_text(file.string())));
    fs::remove(file);
  }
}

#else

void pack_files(const std::string&) {}

#endif

bool is_packed_or_plain(const std::string& path) {
  std::error_code code;
  return fs::exists(path, code) || fs::exists(path + kEnding, code);
}

std::string read_packed_or_plain(const std::string& path) {
  std::error_code code;
  if (fs::exists(path, code)) return read_text(path);
  return decompressed(path + kEnding, read_text(path + kEnding));
}

}  // namespace plumb::harness
