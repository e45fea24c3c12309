/** English texts of the page around the views. */
export const page = {
  title: "Sprag",
};
