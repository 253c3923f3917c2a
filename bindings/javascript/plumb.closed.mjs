// Objects that have only the properties of their class.
import {refuse} from "./plumb.definitions.mjs";

const kClosed = {};  // classes by their kind, because a bundler may rename them
/// Has only the properties of its class: others are refused. The proxy is the last prototype, so that it is asked about
/// nothing that exists. Fields of a derived class are its own.
export class Closed {}
Object.setPrototypeOf(Closed.prototype, new Proxy({}, {
  set(_, name, value, object) {
    const others = settable(object).join(", ") || "nothing";
    refuse(String(name), value, `is not a property of a ${object._kind}; can be set: ${others}`, "UnknownName");
  },
}));
function settable(object) {
  const all = Object.entries(Object.getOwnPropertyDescriptors(kClosed[object._kind].prototype));
  return all.filter(([, {set}]) => set !== undefined && !set.refuses).map(([name]) => name);
}
/// Makes properties that are only read say so when they are set.
function refuseToSet({prototype}) {
  for (const [name, property] of Object.entries(Object.getOwnPropertyDescriptors(prototype))) {
    if (property.get === undefined || property.set !== undefined) continue;
    const set = (value) => refuse(name, value, "is read only", "Unsupported");
    Object.defineProperty(prototype, name, {...property, set: Object.assign(set, {refuses: true})});
  }
}
/// Closes classes, given by their kinds: call it once they are whole.
export function close(classes) {
  Object.assign(kClosed, classes);
  for (const Type of Object.values(classes)) refuseToSet(Type);
}
