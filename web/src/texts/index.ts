/** All texts of the page. Another language is another folder beside `en` with the same types, chosen here. */
import { page } from "./en/page";
import { views } from "./en/views";

/** The texts of a language. */
export interface Texts {
  page: typeof page;
  views: typeof views;
}

/** The texts that are shown. */
export const texts: Texts = { page, views };
