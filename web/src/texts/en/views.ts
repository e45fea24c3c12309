/** English texts of map, controller and trust. */
export const views = {};
