#pragma once

namespace plumb {

/// Owns an object from `new`, as std::unique_ptr does. For public headers: <memory> takes longer to include
/// than everything else in them. Null after it was moved from.
template <class T>
class OwnedPointer {
 public:
  OwnedPointer() = default;
  explicit OwnedPointer(T* it) : it_(it) {}
  OwnedPointer(OwnedPointer&& other) noexcept : it_(other.release()) {}
  OwnedPointer& operator=(OwnedPointer&& other) noexcept {
    T* const old = it_;
    it_ = other.release();
    if (old != it_) destroy(old);
    return *this;
  }
  ~OwnedPointer() { destroy(it_); }

  T& operator*() const { return *it_; }
  T* operator->() const { return it_; }
  T* get() const { return it_; }
  /// Gives the object away: the caller deletes it.
  T* release() {
    T* const it = it_;
    it_ = nullptr;
    return it;
  }

 private:
  static void destroy(T* it) {
    static_assert(sizeof(T) > 0, "deleted where its type is known");
    delete it;
  }

  T* it_ = nullptr;
};

}  // namespace plumb
