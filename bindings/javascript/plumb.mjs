// plumb's world for JavaScript: the .cpp files beside it list the calls, plumb.d.ts the types and units. Works in browsers and in
// Node; needs no threads, no special headers and no files but those of the package.
export {PlumbError} from "./plumb.definitions.mjs";
export {Body, Chain, Joint, Shape} from "./plumb.handles.mjs";
export {Rollback} from "./plumb.rollback.mjs";
export {World} from "./plumb.world.mjs";
