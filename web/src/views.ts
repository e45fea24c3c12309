/** The sections below the histories, in their order: each module calls `mountView`. */
import "./map/section";
import "./loop/section";
import "./trust/section";
