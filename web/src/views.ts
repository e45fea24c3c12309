/** The sections below the histories, in their order: each module calls `mountView`. */
export {};
