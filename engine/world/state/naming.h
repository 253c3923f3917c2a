#pragma once

#include <string>

#include "engine/scene/error.h"
#include "engine/scene/subject.h"
#include "engine/world/world_data.h"

/// Helpers by which errors name the subject of the call.
namespace plumb {

/// Calls `check` and rethrows its errors with `subject()` as their subject.
template <class Subject, class Check>
void with_subject(Subject&& subject, Check&& check) {
  try {
    check();
  } catch (const Error& error) {
    throw Error(error.kind(), subject(), error.field(), error.value(), error.problem(), error.line());
  }
}

/// Returns "body 'ball'", or "body 3" by its handle's index if it has no name.
template <class Real>
std::string body_subject(const WorldData<Real>& w, int body) {
  return body_subject(static_cast<std::size_t>(body), w.extras_of(body).name);
}

template <class Real, class Check>
void with_body_subject(const WorldData<Real>& w, int body, Check&& check) {
  with_subject([&] { return body_subject(w, body); }, check);
}

/// Checks a part of a body; errors name "shape of body 'ball'", with `part` for "shape".
template <class Real, class Check>
void with_part_subject(const WorldData<Real>& w, const std::string& part, int body, Check&& check) {
  with_subject([&] { return part + " of " + body_subject(w, body); }, check);
}

}  // namespace plumb
