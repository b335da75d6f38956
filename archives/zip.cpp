// SPDX-License-Identifier: GPL-3.0-or-later
#include "archives/zip.h"

#include <minizip/unzip.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <set>
#include <utility>

namespace watertight::archives {
namespace {

constexpr std::size_t kLongestName = 65535;  // the format has 16 bits for it
constexpr uLong kEncrypted = 1;              // of the general purpose flags
constexpr uLong kStored = 0;
constexpr uLong kDeflated = 8;

Error broken(std::string reason) { return {ErrorCode::malformed, "zip: " + std::move(reason)}; }

Error no_members() { return broken("the archive has no members"); }

/// Whether an archive is an end without members before it, which minizip does not read.
bool is_empty(const RandomBytes& bytes) {
  constexpr std::uint64_t kEnd = 22;  // without a comment
  Bytes first(4);
  const auto count = bytes.read(0, first);
  return bytes.size == kEnd && count && *count == first.size() && as_text(first) == "PK\x05\x06";
}

/// A position in the bytes of an archive, as minizip wants a file to be.
struct Cursor {
  RandomBytes bytes;
  std::uint64_t at = 0;
  std::optional<Error> failure = {};  // of the bytes; minizip knows only that there is one
  // A read went beyond the end. minizip would take missing bytes for zeros without a failure.
  bool is_beyond = false;
};

// Functions of a file for minizip; `stream` is a Cursor.

voidpf ZCALLBACK open_cursor(voidpf opaque, const void* /*name*/, int /*mode*/) { return opaque; }

uLong ZCALLBACK read_cursor(voidpf /*opaque*/, voidpf stream, void* out, uLong size) {
  auto& cursor = *static_cast<Cursor*>(stream);
  const std::span<std::uint8_t> place(static_cast<std::uint8_t*>(out), size);
  std::size_t done = 0;
  while (done < place.size()) {
    const auto count = cursor.bytes.read(cursor.at, place.subspan(done));
    if (!count) cursor.failure = count.error();
    if (!count || *count == 0) break;
    done += *count;
    cursor.at += *count;
  }
  if (done < place.size()) cursor.is_beyond = true;
  return done;
}

uLong ZCALLBACK write_cursor(voidpf /*opaque*/, voidpf /*stream*/, const void* /*in*/,
                             uLong /*size*/) {
  return 0;
}

ZPOS64_T ZCALLBACK tell_cursor(voidpf /*opaque*/, voidpf stream) {
  return static_cast<Cursor*>(stream)->at;
}

long ZCALLBACK seek_cursor(voidpf /*opaque*/, voidpf stream, ZPOS64_T offset, int origin) {
  auto& cursor = *static_cast<Cursor*>(stream);
  std::uint64_t start = 0;
  if (origin == ZLIB_FILEFUNC_SEEK_CUR) start = cursor.at;
  if (origin == ZLIB_FILEFUNC_SEEK_END) start = cursor.bytes.size;
  const std::uint64_t size = cursor.bytes.size;
  if (start > size || offset > size - start) return -1;
  cursor.at = start + offset;
  return 0;
}

int ZCALLBACK close_cursor(voidpf /*opaque*/, voidpf /*stream*/) { return 0; }

int ZCALLBACK error_of_cursor(voidpf /*opaque*/, voidpf stream) {
  const auto& cursor = *static_cast<Cursor*>(stream);
  return cursor.failure || cursor.is_beyond ? 1 : 0;
}

/// An open archive.
class Archive {
 public:
  explicit Archive(RandomBytes bytes) : cursor_{std::move(bytes)} {
    zlib_filefunc64_def functions{open_cursor, read_cursor,  write_cursor,    tell_cursor,
                                  seek_cursor, close_cursor, error_of_cursor, &cursor_};
    file_ = unzOpen2_64("", &functions);
  }
  ~Archive() {
    if (file_ != nullptr) unzClose(file_);
  }
  Archive(const Archive&) = delete;
  Archive& operator=(const Archive&) = delete;

  unzFile file() const { return file_; }
  /// The error of the bytes, if they have failed, else `reason`.
  Error error(std::string reason) const {
    return cursor_.failure ? *cursor_.failure : broken(std::move(reason));
  }

 private:
  Cursor cursor_;
  unzFile file_ = nullptr;
};

/// The member that the archive's list is at.
Result<ZipMember> current_member(const Archive& archive, std::vector<char>& name) {
  unz_file_info64 info{};
  unz64_file_pos place{};
  if (unzGetCurrentFileInfo64(archive.file(), &info, name.data(), name.size(), nullptr, 0, nullptr,
                              0) != UNZ_OK ||
      unzGetFilePos64(archive.file(), &place) != UNZ_OK) {
    return archive.error("the list of members is broken");
  }
  ZipMember member{
      std::string(name.data(), std::min<std::size_t>(info.size_filename, kLongestName)),
      info.uncompressed_size, place.pos_in_zip_directory, place.num_of_file};
  return member;
}

/// The member that a source reads.
class MemberReader {
 public:
  MemberReader(std::unique_ptr<Archive> archive, ZipMember member,
               std::shared_ptr<ExpansionCount> count)
      : archive_(std::move(archive)), member_(std::move(member)), count_(std::move(count)) {}

  Result<std::size_t> read(std::span<std::uint8_t> out) {
    if (failure_) return *failure_;
    auto given = expand(out);
    if (!given) failure_ = given.error();
    return given;
  }

 private:
  Result<std::size_t> expand(std::span<std::uint8_t> out) {
    if (is_at_end_) return std::size_t{0};
    constexpr std::size_t kMost = std::size_t{1} << 30U;  // minizip returns an int
    const auto size = static_cast<unsigned>(std::min(out.size(), kMost));
    const int count = unzReadCurrentFile(archive_->file(), out.data(), size);
    if (count < 0) return archive_->error("the data of the member are broken");
    if (count == 0) return finish();
    given_ += static_cast<std::uint64_t>(count);
    if (Status status = count_->add(static_cast<std::uint64_t>(count)); !status) {
      return std::move(status).error();
    }
    return static_cast<std::size_t>(count);
  }

  Result<std::size_t> finish() {
    is_at_end_ = true;
    if (given_ != member_.size) return archive_->error("the data of the member end too early");
    // minizip compares the checksum when a member that was read to its end is closed.
    if (unzCloseCurrentFile(archive_->file()) != UNZ_OK) {
      return archive_->error("the checksum of the member is wrong");
    }
    return std::size_t{0};
  }

  std::unique_ptr<Archive> archive_;
  ZipMember member_;
  std::shared_ptr<ExpansionCount> count_;
  std::uint64_t given_ = 0;
  bool is_at_end_ = false;
  std::optional<Error> failure_;
};

}  // namespace

Status ExpansionCount::add(std::uint64_t bytes) {
  given_ += bytes;
  if (given_ <= limit_.most(archive_bytes_)) return Done{};
  return Error{ErrorCode::limit_exceeded,
               "zip: the archive expands to more than " + std::to_string(limit_.bytes) +
                   " bytes and more than " + std::to_string(limit_.ratio) + " times its size"};
}

Result<std::vector<ZipMember>> zip_members(const RandomBytes& bytes) {
  const Archive archive(bytes);
  if (archive.file() == nullptr) {
    if (is_empty(bytes)) return no_members();
    return archive.error("there is no list of members at the end; is the archive cut off?");
  }
  unz_global_info64 info{};
  unzGetGlobalInfo64(archive.file(), &info);
  std::vector<ZipMember> members;
  if (info.number_entry == 0) return no_members();
  std::vector<char> name(kLongestName + 1);
  std::set<std::string> names;
  int status = unzGoToFirstFile(archive.file());
  for (; status == UNZ_OK; status = unzGoToNextFile(archive.file())) {
    auto member = current_member(archive, name);
    if (!member) return std::move(member).error();
    if (member->name.empty()) return broken("a member has no name");
    if (member->name.ends_with('/')) continue;
    if (!names.insert(member->name).second) {
      return broken("two members have the name '" + member->name + "'");
    }
    members.push_back(*std::move(member));
  }
  if (status != UNZ_END_OF_LIST_OF_FILE) return archive.error("the list of members is broken");
  if (members.empty()) return broken("the archive has no files");
  return members;
}

Result<ByteSource> open_member(RandomBytes bytes, const ZipMember& member,
                               std::shared_ptr<ExpansionCount> count) {
  auto archive = std::make_unique<Archive>(std::move(bytes));
  if (archive->file() == nullptr) return archive->error("the archive has changed");
  unz64_file_pos place{};
  place.pos_in_zip_directory = member.place;
  place.num_of_file = member.number;
  unz_file_info64 info{};
  if (unzGoToFilePos64(archive->file(), &place) != UNZ_OK ||
      unzGetCurrentFileInfo64(archive->file(), &info, nullptr, 0, nullptr, 0, nullptr, 0) !=
          UNZ_OK) {
    return archive->error("the archive has changed");
  }
  if ((info.flag & kEncrypted) != 0) {
    return Error{ErrorCode::unsupported, "zip: the member is encrypted"};
  }
  if (info.compression_method != kStored && info.compression_method != kDeflated) {
    return Error{ErrorCode::unsupported, "zip: the member has compression method " +
                                             std::to_string(info.compression_method) +
                                             "; only stored and deflated members are read"};
  }
  if (unzOpenCurrentFile(archive->file()) != UNZ_OK) {
    return archive->error("the head of the member does not fit the list of members");
  }
  const auto reader = std::make_shared<MemberReader>(std::move(archive), member, std::move(count));
  return ByteSource([reader](std::span<std::uint8_t> out) { return reader->read(out); });
}

}  // namespace watertight::archives
