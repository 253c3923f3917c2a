#include "engine/world/recording/recording_file.h"

#include "engine/core/text.h"
#include "engine/encoding/encoding.h"
#include "engine/scene/error.h"
#include "engine/world/checksum.h"
#include "engine/world/recording/recorded_calls.h"

namespace plumb {
namespace {

// Version of the format. Increase it if the meaning of records changes. Appending new calls to the table
// needs no increase.
constexpr std::uint32_t kVersion = 11;

// "plumbrec" in little-endian order.
constexpr std::uint64_t kMagic = 0x636572626D756C70u;

struct FileHeader {
  std::uint64_t magic = kMagic;
  std::uint32_t version = kVersion;
  std::uint32_t real = 0;  ///< bytes of a Real
};

struct RecordHeader {
  std::uint32_t size = 0;  ///< bytes of kind and content
  std::uint32_t sum = 0;   ///< lower half of their checksum
};

std::uint32_t short_sum(std::span<const std::byte> bytes) {
  return static_cast<std::uint32_t>(checksum(bytes));
}

}  // namespace

PLUMB_MEMBERS(FileHeader, magic, version, real)
PLUMB_MEMBERS(RecordHeader, size, sum)

namespace {

constexpr std::size_t kHeaderSize = packed_size<RecordHeader>();

}  // namespace

RecordingWriter::RecordingWriter(const std::filesystem::path& file, int bytes_of_real)
    : name_(file.string()), file_(std::fopen(name_.c_str(), "wb")) {
  if (!file_) throw Error(Error::Kind::Io, kRecording, "file", printable(name_), "cannot be written");
  Encoder(record_).put(FileHeader{.real = static_cast<std::uint32_t>(bytes_of_real)});
  write(record_);
  flush();
}

std::vector<std::byte>& RecordingWriter::begin(RecordKind kind) {
  record_.assign(kHeaderSize, std::byte{0});
  record_.push_back(static_cast<std::byte>(kind));
  return record_;
}

void RecordingWriter::commit() {
  const std::span<const std::byte> content = std::span(record_).subspan(kHeaderSize);
  std::byte* to = record_.data();
  Encoder::pack(to, RecordHeader{static_cast<std::uint32_t>(content.size()), short_sum(content)});
  write(record_);
}

void RecordingWriter::flush() {
  if (std::fflush(file_.get()) != 0)
    throw Error(Error::Kind::Io, kRecording, "file", printable(name_), "cannot be written to any more");
}

void RecordingWriter::write(std::span<const std::byte> bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size())
    throw Error(Error::Kind::Io, kRecording, "file", printable(name_), "cannot be written to any more");
}

RecordingReader::RecordingReader(const std::filesystem::path& file, int bytes_of_real) {
  const std::string name = file.string();
  std::FILE* in = std::fopen(name.c_str(), "rb");
  if (in == nullptr) throw Error(Error::Kind::Io, kRecording, "file", printable(name), "cannot be read");
  std::byte chunk[65536];
  for (std::size_t got; (got = std::fread(chunk, 1, sizeof(chunk), in)) > 0;)
    bytes_.insert(bytes_.end(), chunk, chunk + got);
  const bool broken = std::ferror(in) != 0;
  std::fclose(in);
  if (broken) throw Error(Error::Kind::Io, kRecording, "file", printable(name), "cannot be read");
  Decoder decoder(bytes_, kRecording);
  const FileHeader header = decoder.get<FileHeader>("header");
  decoder.require(header.magic == kMagic, "header", "is not that of a recording");
  decoder.require(header.version == kVersion, "version", "is another one than this program's");
  decoder.require(header.real == static_cast<std::uint32_t>(bytes_of_real), "precision",
                  "is another one than this world's");
  offset_ = packed_size<FileHeader>();
}

auto RecordingReader::next() -> std::optional<Record> {
  const std::span<const std::byte> rest = std::span(bytes_).subspan(offset_);
  if (rest.empty()) return std::nullopt;
  const auto cut_off = [&]() -> std::optional<Record> {
    message_ = "the last record is cut off: " + std::to_string(rest.size()) +
               " bytes at the end of the file " + "were left out";
    offset_ = bytes_.size();
    return std::nullopt;
  };
  if (rest.size() < kHeaderSize) return cut_off();
  const RecordHeader header = Decoder(rest, kRecording).get<RecordHeader>("record");
  if (header.size > rest.size() - kHeaderSize) return cut_off();
  const std::span<const std::byte> content = rest.subspan(kHeaderSize, header.size);
  if (header.size == 0 || header.sum != short_sum(content)) {
    if (content.size() + kHeaderSize == rest.size()) return cut_off();
    throw Error(Error::Kind::Value, kRecording, "record", std::to_string(count_ + 1),
                "is damaged: its checksum does not fit");
  }
  offset_ += kHeaderSize + header.size;
  ++count_;
  return Record{static_cast<RecordKind>(content[0]), content.subspan(1)};
}

}  // namespace plumb
