#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// The file of a recording: a header, then records in sequence, each with its size and checksum.
/// docs/guide/recording.md describes the format.
namespace plumb {

/// Names a recording in errors.
inline constexpr char kRecording[] = "recording";

/// Kind of a record; a Call also has its WorldCall.
enum class RecordKind : std::uint8_t {
  Call = 0,        ///< WorldCall and arguments
  Definition = 1,  ///< the world's definition
  State = 2,       ///< a snapshot that replaces the world's state
  Hash = 3,        ///< after a step: hashes of the world and of the awake bodies
  Hook = 4,        ///< a pre-solve hook was set (true) or removed
};

/// Writes records; those before a step reach the operating system before the step is taken.
class RecordingWriter {
 public:
  /// Creates a new file. Throws Error (Io) if it cannot be written.
  RecordingWriter(const std::filesystem::path& file, int bytes_of_real);

  /// Starts a record; kind and content are appended to the returned buffer.
  std::vector<std::byte>& begin(RecordKind kind);
  /// Writes it to the file.
  void commit();
  /// Passes all records to the operating system, so that they outlive this process. Throws Error (Io) if the
  /// disk is full.
  void flush();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  void write(std::span<const std::byte> bytes);

  std::string name_;
  std::unique_ptr<std::FILE, Close> file_;
  std::vector<std::byte> record_;
};

/// Reads records.
class RecordingReader {
 public:
  /// Throws Error (Io) if the file cannot be read. Throws Error (Value, "recording") if it is not a
  /// recording, or has another version or precision.
  RecordingReader(const std::filesystem::path& file, int bytes_of_real);

  struct Record {
    RecordKind kind;
    std::span<const std::byte> content;
  };
  /// Returns the next record; nullopt at the end. If the last record is truncated (the recording program was
  /// killed), the file ends there with a message. Throws Error (Value, "recording") for a damaged record.
  std::optional<Record> next();

  /// Returns a message about the end of the file, or an empty string.
  const std::string& message() const { return message_; }
  /// Returns the number of records read so far.
  int count() const { return count_; }

 private:
  std::vector<std::byte> bytes_;
  std::size_t offset_ = 0;
  int count_ = 0;
  std::string message_;
};

}  // namespace plumb
