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

/// The file of a recording: a header, then records one after another, each with its size and checksum.
/// docs/guide/recording.md has the format.
namespace plumb {

/// What a record holds, besides the calls: those have their WorldCall.
enum class RecordKind : std::uint8_t {
  Call = 0,        ///< WorldCall and arguments
  Definition = 1,  ///< what the world was made from
  State = 2,       ///< a snapshot: the world is this from here on
  Hash = 3,        ///< after a step: the world's hash, and those of the bodies that are awake
  Hook = 4,        ///< a pre-solve hook was set (true) or taken away
};

/// Writes records; those of a step reach the operating system before the step is taken.
class RecordingWriter {
 public:
  /// Begins a new file. Throws Error (Io) when it cannot be written.
  RecordingWriter(const std::filesystem::path& file, int bytes_of_real);

  /// The record that is being made: kind and content are to be put here.
  std::vector<std::byte>& begin(RecordKind kind);
  /// Puts it into the file.
  void commit();
  /// Hands all records to the operating system: they outlive this process. Throws Error (Io) when the disk is
  /// full.
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
  /// Throws Error (Io) when the file cannot be read, Error (Value, "recording") when it is none, of another
  /// version or of the other precision.
  RecordingReader(const std::filesystem::path& file, int bytes_of_real);

  struct Record {
    RecordKind kind;
    std::span<const std::byte> content;
  };
  /// The next record; none at the end. A last record that is cut off, as when the program that recorded was
  /// killed, ends the file with a message. Throws Error (Value, "recording") for one that is damaged.
  std::optional<Record> next();

  /// What there is to say about the end of the file; empty: nothing.
  const std::string& message() const { return message_; }
  /// Records that were read so far.
  int count() const { return count_; }

 private:
  std::vector<std::byte> bytes_;
  std::size_t at_ = 0;
  int count_ = 0;
  std::string message_;
};

}  // namespace plumb
